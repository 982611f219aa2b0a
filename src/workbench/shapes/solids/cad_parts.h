#pragma once

#include <string>

#include "pcednet/core/random.h"
#include "workbench/shapes/solids/solid.h"

namespace pcednet::shapes {

/// The number of part families.
inline constexpr int kPartFamilies = 12;

/// The name of a family: "plate", "bracket", ...
std::string part_family_name(int family);

/// A CAD part about one unit large: extruded and revolved profiles with fillets and chamfers,
/// holes, slots, pockets, ribs, thin walls and teeth, in many proportions and sizes.
Solid random_part(int family, Random& random);

}  // namespace pcednet::shapes
