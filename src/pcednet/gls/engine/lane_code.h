#pragma once

#include "pcednet/gls/engine/lane_inside_add.h"
#include "pcednet/gls/engine/lane_inside_sums.h"
#include "pcednet/gls/engine/lane_select.h"
#include "pcednet/gls/engine/lane_solve.h"
#include "pcednet/gls/engine/lane_sums.h"

namespace pcednet::gls {
namespace {

/// All vector code with W floats per register, for the unit of one instruction set.
template <int W>
constexpr LaneKernels lane_code(const char* name) {
  return {name,          select<W>,     split<W>, part_open, sum<W>,
          sum_inside<W>, add_inside<W>, count<W>, solve<W>};
}

}  // namespace
}  // namespace pcednet::gls
