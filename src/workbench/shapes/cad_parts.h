#pragma once

#include <string>

#include "pcednet/core/random.h"
#include "workbench/shapes/solid.h"

namespace pcednet::shapes {

/// The families of parts that random_part() knows.
inline constexpr int kPartFamilies = 12;

/// The name of a family: "plate", "bracket", ...
std::string part_family_name(int family);

/// A part about one unit large, as CAD programs make them: profiles with fillets and chamfers drawn
/// and turned, holes, slots, pockets, ribs, thin walls, teeth, in many proportions and sizes.
Solid random_part(int family, Random& random);

}  // namespace pcednet::shapes
