#include "workbench/shapes/terrain.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pcednet/core/random_vectors.h"
#include "workbench/shapes/cad_set.h"
#include "workbench/shapes/solids/part_pieces.h"
#include "workbench/shapes/surfaces/roofs.h"
#include "workbench/shapes/surfaces/sampling.h"

namespace pcednet::shapes {
namespace {

using View = TerrainRecipe::View;

constexpr double kHalf = 40.0, kNearest = 2.0;  // metres: of the square, and of the tripod's view
constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Waves of every length from 30 metres to a decimetre.
class Ground {
 public:
  explicit Ground(Random& random) {
    const double steepness = size_between(random, 0.004, 0.06);
    const double growth = random.uniform(0.8, 1.1);  // of the steepness from wave to wave
    double length = 30.0, steep = steepness;
    for (int octave = 0; octave < 9; ++octave, length *= 0.5, steep *= growth) {
      waves_.push_back({steep * length, kTwoPi / length, random.uniform(0.0, kTwoPi),
                        random.uniform(0.0, kTwoPi)});
    }
  }

  double height(double x, double y) const {
    double z = 0.0;
    for (const Wave& wave : waves_) {
      const double c = std::cos(wave.turn), s = std::sin(wave.turn);
      z += wave.height * std::sin(wave.number * (c * x + s * y) + wave.phase) *
           std::cos(0.77 * wave.number * (c * y - s * x));
    }
    return z;
  }

  Vec3 at(double x, double y) const { return {x, y, height(x, y)}; }

  Vec3 normal(double x, double y) const {
    constexpr double kStep = 0.02;
    return Vec3(height(x - kStep, y) - height(x + kStep, y),
                height(x, y - kStep) - height(x, y + kStep), 2 * kStep)
        .normalized();
  }

 private:
  struct Wave {
    double height, number, turn, phase;
  };
  std::vector<Wave> waves_;
};

struct House {
  Shape shape;
  Vec3 centre;
  double reach;  ///< nothing else is nearer to its axis
};

struct Land {
  Ground ground;
  std::vector<House> houses;
  std::vector<Vec3> positions = {}, normals = {};

  void add(const Vec3& position, const Vec3& normal) {
    positions.push_back(position);
    normals.push_back(normal);
  }

  bool under_house(double x, double y) const {
    return std::any_of(houses.begin(), houses.end(), [&](const House& house) {
      return std::hypot(x - house.centre.x(), y - house.centre.y()) < house.reach;
    });
  }
};

/// A roof of random_roof() or the five upper faces of a box.
House random_house(View view, const Ground& ground, Random& random) {
  const double turn = random.uniform(0.0, kTwoPi), distance = random.uniform(8.0, 32.0);
  const double x = distance * std::cos(turn), y = distance * std::sin(turn);
  Polyhedron solid = random_roof(static_cast<int>(random.index(kRoofKinds)), random);
  Vec3 foot = ground.at(x, y);
  if (view == View::kTripod) {
    solid = cube();
    const auto is_low = [&](int corner) {
      return solid.corners[static_cast<std::size_t>(corner)].z() < 0;
    };
    std::erase_if(solid.faces, [&](const std::vector<int>& face) {
      return std::all_of(face.begin(), face.end(), is_low);
    });
    const Vec3 size = uniform_vector(random, {1, 1, 0.5}, {6, 6, 6});
    for (Vec3& corner : solid.corners) corner = corner.cwiseProduct(size);
  } else {
    foot.z() += random.uniform(3.0, 8.0);
  }
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.translate(foot).rotate(Eigen::AngleAxisd(random.uniform(0.0, kTwoPi), Vec3::UnitZ()));
  House house = {{}, foot, 0.0};
  append(house.shape, make_shape(solid), frame);
  for (const Vec3& corner : solid.corners) {
    house.reach = std::max(house.reach, std::hypot(corner.x(), corner.y()));
  }
  return house;
}

/// Points per square metre of a surface that faces the scanner.
double density(const TerrainRecipe& recipe, const Vec3& position) {
  const double points = (1.0 - recipe.leaves) * static_cast<double>(recipe.points);
  if (recipe.view != View::kTripod) return points / (4 * kHalf * kHalf);
  const double range = std::max(kNearest, position.norm());
  return points / (kTwoPi * std::log(kHalf / kNearest) * range * range);
}

void scan_house(const House& house, const TerrainRecipe& recipe, Land& land, Random& random) {
  const double nearest = std::max(kNearest, house.centre.norm() - house.reach);
  SampleOptions options;
  options.points =
      static_cast<std::size_t>(density(recipe, house.centre) * surface_area(house.shape));
  if (options.points == 0) return;
  if (recipe.view == View::kTripod) {
    options.keep = [nearest](const Vec3& position) {
      return std::min(1.0, nearest * nearest / position.squaredNorm());
    };
  }
  const SurfaceSamples samples = sample_surface(house.shape, options, random);
  for (std::size_t i = 0; i < samples.positions.size(); ++i) {
    land.add(samples.positions[i], samples.normals[i]);
  }
}

/// A place in the square, or on a scan line round the tripod: close to the last along the line, far
/// from the next line.
Vec3 ground_place(const TerrainRecipe& recipe, double lines, Random& random) {
  const double line = std::floor(random.uniform() * lines) / lines;
  if (recipe.view == View::kTripod) {
    const double range = kNearest * std::pow(kHalf / kNearest, random.uniform());
    return {range * std::cos(kTwoPi * line), range * std::sin(kTwoPi * line), 0};
  }
  const double x = random.uniform(-kHalf, kHalf), y = random.uniform(-kHalf, kHalf);
  return {x, recipe.view == View::kAirborne ? kHalf * (2 * line - 1) : y, 0};
}

void scan_ground(const TerrainRecipe& recipe, Land& land, Random& random) {
  const auto points =
      static_cast<std::size_t>((1.0 - recipe.leaves) * static_cast<double>(recipe.points));
  const double lines = std::sqrt(static_cast<double>(points) / random.uniform(1.0, 5.0));
  const double grass = random.index(2) ? 0.0 : size_between(random, 0.02, 0.4);  // its height
  while (land.positions.size() < points) {
    const Vec3 place = ground_place(recipe, lines, random);
    if (land.under_house(place.x(), place.y())) continue;
    const Vec3 foot = land.ground.at(place.x(), place.y());
    const double blade = grass * random.uniform() * random.uniform();
    land.add(foot + Vec3(0, 0, blade), land.ground.normal(place.x(), place.y()));
  }
}

/// A crown or hedge full of leaves, or its outer leaves alone, and a trunk.
class Plant {
 public:
  Plant(const Land& land, Random& random)
      : size_(uniform_vector(random, {0.3, 0.3, 0.4}, {3.0, 3.0, 3.0})),
        hollow_(random.uniform(0.0, 0.9)),
        box_(random.index(4) == 0),
        trunk_(random.index(2) ? 0.0 : random.uniform(0.03, 0.2)) {
    do {
      foot_ = {random.uniform(-0.9, 0.9) * kHalf, random.uniform(-0.9, 0.9) * kHalf, 0};
    } while (land.under_house(foot_.x(), foot_.y()));
    foot_ = land.ground.at(foot_.x(), foot_.y());
  }

  const Vec3& foot() const { return foot_; }

  void add_point(Land& land, Random& random) const {
    const Vec3 out = any_direction(random);
    if (trunk_ > 0.0 && random.uniform() < 0.1) {
      const Vec3 side = Vec3(out.x(), out.y(), 0).normalized();
      land.add(foot_ + trunk_ * side + Vec3(0, 0, size_.z() * random.uniform()), side);
      return;
    }
    const Vec3 in_box = uniform_vector(random, -Vec3::Ones(), Vec3::Ones());
    const Vec3 in_crown = box_ ? in_box : std::cbrt(random.uniform(hollow_, 1.0)) * out;
    land.add(foot_ + size_.cwiseProduct(in_crown + Vec3(0, 0, trunk_ > 0.0 ? 1.7 : 0.9)),
             any_direction(random));
  }

 private:
  Vec3 size_, foot_;
  double hollow_;
  bool box_;
  double trunk_;  ///< its radius; 0: none
};

void add_plants(const TerrainRecipe& recipe, Land& land, Random& random) {
  const auto number = 3 + random.index(40);
  std::vector<Plant> plants;
  for (std::size_t i = 0; i < number; ++i) plants.emplace_back(land, random);
  const auto points = static_cast<std::size_t>(recipe.leaves * static_cast<double>(recipe.points));
  for (std::size_t i = 0; i < points; ++i) {
    plants[random.index(plants.size())].add_point(land, random);
  }
}

std::vector<std::uint8_t> labels_of(const Land& land) {
  const std::vector<double> spacings = local_spacings(land.positions);
  std::vector<std::uint8_t> labels(land.positions.size(), kNonEdge);
  for (const House& house : land.houses) {
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if ((land.positions[i] - house.centre).norm() > 3.0 * house.reach) continue;
      const auto label = label_by_distance(std::span(&land.positions[i], 1), house.shape.edges,
                                           spacings[i] * kPartBands)[0];
      labels[i] = std::max(labels[i], label);
    }
  }
  return labels;
}

std::vector<Vec3> disturbed(std::vector<Vec3> normals, Random& random) {
  constexpr double kOfNormals = 0.2;
  add_noise(normals, kOfNormals, random);
  for (Vec3& normal : normals) normal.normalize();
  return normals;
}

}  // namespace

std::vector<TerrainRecipe> terrain_recipes(std::uint64_t seed) {
  constexpr std::size_t kTerrains = 30;
  std::vector<TerrainRecipe> recipes;
  for (std::size_t i = 0; i < kTerrains; ++i) {
    Random random(seed, 61000 + i);
    const View view = std::array{View::kTripod, View::kAirborne, View::kDrone}[i % 3];
    const char* name = std::array{"tripod", "airborne", "drone"}[i % 3];
    recipes.push_back({.name = fmt::format("terrain_{}_{}", name, i / 3),
                       .view = view,
                       .points = points_between(random, 8000, 50000),
                       .leaves = random.uniform(0.05, 0.6),
                       .houses = static_cast<int>(random.index(6)),
                       .given_normals = i % 5 == 4});
  }
  return recipes;
}

GeneratedCloud generate(const TerrainRecipe& recipe, std::uint64_t seed) {
  Random random = Random(seed, 62000 + recipe.points);
  Land land = {Ground(random), {}};
  for (int i = 0; i < recipe.houses; ++i) {
    land.houses.push_back(random_house(recipe.view, land.ground, random));
  }
  for (const House& house : land.houses) scan_house(house, recipe, land, random);
  scan_ground(recipe, land, random);
  add_plants(recipe, land, random);
  add_noise(land.positions, size_between(random, 0.002, 0.05), random);
  PointCloud cloud;
  for (Vec3& position : land.positions) position = position.cast<float>().cast<double>();
  cloud.labels = labels_of(land);
  cloud.normals =
      recipe.given_normals ? disturbed(land.normals, random) : oriented_normals(land.positions);
  cloud.positions = std::move(land.positions);
  cloud.position_type = ScalarType::kFloat32;
  cloud.comments = {fmt::format("generated by pcednet: {}, seed {}", recipe.name, seed)};
  return {recipe.name, std::move(cloud)};
}

}  // namespace pcednet::shapes
