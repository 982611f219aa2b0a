#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pcednet/core/random.h"
#include "workbench/shapes/recipe.h"
#include "workbench/shapes/solids/mesh_vertices.h"
#include "workbench/shapes/surfaces/shape.h"

namespace pcednet::shapes {

/// The labelled bands of points drawn from a part, in spacings.
inline constexpr EdgeBands kPartBands = {.sharp = 0.6, .smooth = 1.73};

/// How a labelled cloud of a CAD part is made.
struct CadRecipe {
  std::string name = {};
  int family = 0;                ///< of random_part()
  std::uint64_t part = 0;        ///< number of the part in the family
  bool mesh = true;              ///< vertices of a mesh; else points sampled uniformly by area
  bool even = false;             ///< no sampled point is near another
  bool one_point_wide = false;   ///< only the points nearest to the curves are sharp-edge
  MeshStyle style = {};          ///< of the mesh; `points` for sampled points, too
  double noise = 0.0;            ///< along the normal, standard deviation over the box's diagonal
  bool estimated = false;        ///< normals estimated from the positions; else those of the part
  bool inward = false;           ///< all normals point into the solid
  EdgeBands bands = kPartBands;  ///< in spacings; vertices on edges are sharp
  double wear = 0.0;     ///< rounding of edges: standard deviation of a Gaussian, in spacings
  double scatter = 0.0;  ///< noise on each axis, in spacings
};

/// A mesh of `least` to `most` vertices, small numbers as likely as large ones, with planes meshed
/// more or less coarsely.
MeshStyle random_mesh_style(Random& random, double least, double most);

/// A part sampled by area, with normals estimated from the samples.
CadRecipe drawn_part(const std::string& set, int family, int number, std::uint64_t first_part,
                     Random& random);

/// `parts` recipes for each family, from make(family, number).
std::vector<CadRecipe> parts_of_each_family(int parts,
                                            const std::function<CadRecipe(int, int)>& make);

/// The recipes of `pcednet generate cad`.
std::vector<CadRecipe> cad_recipes(std::uint64_t seed);

/// The parts of `pcednet generate worn`: edges rounded as by use, casting or remeshing a scan, on
/// slightly uneven surfaces. The ridge line is sharp-edge, as annotators label it.
std::vector<CadRecipe> worn_recipes(std::uint64_t seed);

/// The class of each position by its distance to the sharp borders.
std::vector<std::uint8_t> label_bands(std::span<const Vec3> positions,
                                      std::span<const BorderPoint> borders, const EdgeBands& bands);

/// The first `most` samples, labelled by bands in spacings.
MeshVertices drawn_points(const SolidSamples& samples, std::span<const BorderPoint> borders,
                          std::size_t most, const EdgeBands& bands);

/// The recipe's cloud, randomly rotated; sharp-edge and non-edge. Noise leaves normals unchanged.
GeneratedCloud generate(const CadRecipe& recipe, std::uint64_t seed);

}  // namespace pcednet::shapes
