#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "workbench/shapes/mesh_vertices.h"
#include "workbench/shapes/recipe.h"

namespace pcednet::shapes {

/// How a labelled cloud of a CAD part is made.
struct CadRecipe {
  std::string name = {};
  int family = 0;          ///< of random_part()
  std::uint64_t part = 0;  ///< which part of the family
  bool mesh = true;        ///< vertices of a mesh; else points drawn from the surface by area
  MeshStyle style = {};    ///< of the mesh; `points` also of drawn points
  double noise = 0.0;      ///< along the normal, standard deviation over the box's diagonal
  bool estimated = false;  ///< normals from the positions, as for files without; else the part's
  bool inward = false;     ///< all normals into the solid
  double band = 0.6;       ///< points this near an edge, in spacings, are sharp-edge; drawn or worn
  double wear = 0.0;       ///< if positive, edges are rounded: a Gaussian of so many spacings
  double scatter = 0.0;    ///< noise of worn parts on each axis, in spacings
};

/// What generate_cad() makes, cloud by cloud.
std::vector<CadRecipe> cad_recipes(std::uint64_t seed);

/// What generate_worn() makes: parts whose edges are rounded by use, by casting or by remeshing a
/// scan, on surfaces that are not quite even. Sharp-edge is the ridge line, as people draw it.
std::vector<CadRecipe> worn_recipes(std::uint64_t seed);

/// The recipe's cloud, turned at random; sharp-edge and non-edge. Noise leaves the normals clean.
GeneratedCloud generate(const CadRecipe& recipe, std::uint64_t seed);

}  // namespace pcednet::shapes
