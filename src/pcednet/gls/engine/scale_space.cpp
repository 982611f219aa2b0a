#include "pcednet/gls/engine/scale_space.h"

namespace pcednet::gls {
namespace {

std::variant<FastScaleSpace, ExactScaleSpace> make_engine(OrientedPoints points,
                                                          ScaleSpaceOptions options,
                                                          const Progress* progress) {
  if (!fits_spheres(options.reconstruction)) options.engine = Engine::kExact;
  if (options.engine == Engine::kExact) return ExactScaleSpace(points, options, progress);
  return FastScaleSpace(points, options, progress);
}

}  // namespace

ScaleSpace::ScaleSpace(OrientedPoints points, const ScaleSpaceOptions& options,
                       const Progress* progress)
    : options_(options), engine_(make_engine(points, options, progress)) {
  options_.engine = std::visit([](const auto& engine) { return engine.options().engine; }, engine_);
}

const std::vector<double>& ScaleSpace::scales() const {
  return std::visit(
      [](const auto& engine) -> const auto& { return engine.scales(); }, engine_);
}

const ScaleRange& ScaleSpace::range() const {
  return std::visit(
      [](const auto& engine) -> const auto& { return engine.range(); }, engine_);
}

void ScaleSpace::take_octave(std::size_t octave, const PyramidPlan* whole,
                             const Progress* progress) {
  if (auto* const fast = std::get_if<FastScaleSpace>(&engine_)) {
    fast->take_octave(octave, whole, progress);
  } else {
    std::get<ExactScaleSpace>(engine_).take_octave(octave);
  }
}

std::span<const std::uint32_t> ScaleSpace::order() const {
  return std::visit([](const auto& engine) { return engine.order(); }, engine_);
}

void ScaleSpace::describe(std::span<const std::uint32_t> targets, std::span<float> out,
                          std::span<FitStatus> status, const Progress* progress) const {
  std::visit([&](const auto& engine) { engine.describe(targets, out, status, progress); }, engine_);
}

}  // namespace pcednet::gls
