#pragma once

#include <set>
#include <span>
#include <string>
#include <vector>

#include "pcednet/cloud/attribute.h"

namespace pcednet::io {

/// The names of the extra bytes for each of the attributes, one per component: NAME, or NAME[0],
/// NAME[1], ...
///
/// LAS has 32 bytes for a name. A longer one is cut between two characters (of UTF-8), so that it
/// differs from `taken`, from all names that fit and from others that are cut; `losses` gets what
/// it becomes. What does not depend on the length is left to the caller: two attributes of one
/// name share their names.
std::vector<std::vector<std::string>> las_extra_names(std::span<const Attribute* const> attributes,
                                                      std::set<std::string> taken,
                                                      std::vector<std::string>& losses);

}  // namespace pcednet::io
