#pragma once

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/formats/cloud_facts.h"

namespace pcednet::app {

/// The bounds, in LAS with as many decimals as the file's scale and offset have: 12.34, where the
/// product of integer and scale is 12.340000000000002.
BoundingBox decimal_bounds(const formats::CloudFacts& facts);

}  // namespace pcednet::app
