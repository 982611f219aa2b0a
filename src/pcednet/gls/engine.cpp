#include "pcednet/gls/engine.h"

#include <algorithm>

namespace pcednet::gls {
namespace {

std::variant<FastScaleSpace, ExactScaleSpace> make_engine(OrientedPoints points,
                                                          ScaleSpaceOptions options,
                                                          const Progress* progress) {
  const bool spheres = options.reconstruction == Reconstruction::kSphere ||
                       options.reconstruction == Reconstruction::kSphereMls;
  if (!spheres) options.engine = Engine::kExact;
  if (options.engine == Engine::kExact) return ExactScaleSpace(points, options, progress);
  return FastScaleSpace(points, options, progress);
}

}  // namespace

ScaleSpace::ScaleSpace(OrientedPoints points, const ScaleSpaceOptions& options,
                       const Progress* progress)
    : options_(options), engine_(make_engine(points, options, progress)) {
  options_.engine = std::visit([](const auto& engine) { return engine.options().engine; }, engine_);
  if (!options.second_gate) return;
  ScaleSpaceOptions second = options;
  second.side_gate = options.second_gate;
  second_ = make_engine(points, second, progress);
}

const std::vector<double>& ScaleSpace::scales() const {
  return std::visit(
      [](const auto& engine) -> const auto& { return engine.scales(); }, engine_);
}

std::span<const std::uint32_t> ScaleSpace::order() const {
  return std::visit([](const auto& engine) { return engine.order(); }, engine_);
}

void ScaleSpace::describe(std::span<const std::uint32_t> targets, std::span<float> out,
                          std::span<FitStatus> status, const Progress* progress) const {
  const auto describe_with = [&](const AnyEngine& any, std::span<float> to,
                                 std::span<FitStatus> its_status) {
    std::visit([&](const auto& engine) { engine.describe(targets, to, its_status, progress); },
               any);
  };
  if (!second_) return describe_with(engine_, out, status);
  const auto count = static_cast<std::ptrdiff_t>(feature_count(options_.features));
  std::vector<float> first(out.size() / 2), second(out.size() / 2);
  std::vector<FitStatus> second_status(status.size());
  describe_with(engine_, first, status);
  describe_with(*second_, second, second_status);
  auto to = out.begin();
  for (auto a = first.cbegin(), b = second.cbegin(); a != first.cend(); a += count, b += count) {
    to = std::copy(b, b + count, std::copy(a, a + count, to));
  }
  std::transform(status.begin(), status.end(), second_status.begin(), status.begin(),
                 [](FitStatus a, FitStatus b) { return std::max(a, b); });
}

}  // namespace pcednet::gls
