#pragma once

#include <string_view>
#include <vector>

#include "pcednet/eval/scores.h"

namespace pcednet::study {

/// A row of a table of Himeur et al. 2021: medians over their clouds of a set, trained on Default.
struct PublishedRow {
  std::string_view set;      ///< default, abc or shrec
  std::string_view variant;  ///< of the experiment "methods"
  eval::Positive positive;
  eval::Scores median;
};
const std::vector<PublishedRow>& published_rows();

}  // namespace pcednet::study
