#include "workbench/study/keys.h"

#include <fmt/format.h>

#include <utility>

#include "pcednet/core/digest.h"
#include "pcednet/core/version.h"
#include "pcednet/detect/classify.h"
#include "workbench/shapes/default_set.h"

namespace pcednet::study {
namespace {

// The structured bindings below name every member, so that a new one does not compile before it
// has its place in the text.

std::string text_of(const nn::Architecture& architecture) {
  const auto& [kind, scales, features, classes, width, hidden] = architecture;
  // Scales and features are the descriptor's.
  static_cast<void>(scales), static_cast<void>(features);
  return fmt::format("network {} classes {} width {} hidden {}", static_cast<int>(kind), classes,
                     width, hidden);
}

std::string text_of(const nn::TrainOptions& options) {
  const auto& [optimiser, learning_rate, anneal, momentum, epochs, batch, balance, least_per_epoch,
               most_per_epoch, standardise, sign_rule, class_names, start, seed] = options;
  // The runner has no model to start from; the signs and the names of the classes follow from the
  // rest.
  static_cast<void>(start), static_cast<void>(class_names), static_cast<void>(sign_rule);
  return fmt::format(
      "optimiser {} rate {} anneal {} momentum {} epochs {} batch {} balance {} least {} most {} "
      "standardise {} seed {}",
      static_cast<int>(optimiser), learning_rate, anneal, momentum, epochs, batch, balance,
      least_per_epoch, most_per_epoch, standardise, seed);
}

std::vector<gls::ScaleSpaceOptions> descriptors_to_try() {
  std::vector<gls::ScaleSpaceOptions> all(gls::reconstruction_names().size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].scales = 8;
    all[i].features = gls::FeatureSet::kAll28;
    all[i].reconstruction = static_cast<gls::Reconstruction>(i);
  }
  gls::ScaleSpaceOptions gated, exact;
  gated.side_gate = -0.2;
  exact.engine = gls::Engine::kExact;
  all.push_back(gated);
  all.push_back(exact);
  return all;
}

void try_networks(const detect::PreparedCloud& cloud, const PointCloud& labelled, Digest& digest) {
  const detect::TrainingCloud training{"probe", cloud, labelled.labels};
  const auto samples = detect::make_samples({&training, 1}, {});
  const auto described = detect::describe(cloud, {});
  for (const auto kind : {nn::NetworkKind::kPcednet, nn::NetworkKind::kFc, nn::NetworkKind::kCnn}) {
    detect::TrainOptions options;
    options.architecture.kind = kind;
    options.training.epochs = 2;
    options.training.least_per_epoch = 1;
    const auto trained = detect::train("probe", samples, options);
    digest.add_values(std::span(std::as_const(trained.model.network.network.parameters)));
    digest.add_values(std::span<const float>(
        detect::classify(described, cloud.positions, trained.model).p_sharp));
  }
}

}  // namespace

std::string text_of(const detect::TrainOptions& options) {
  const auto& [descriptor, architecture, training, symmetry, teachers, context] = options;
  static_cast<void>(context);  // the runner trains on samples, which have no context
  return fmt::format("{}, {}, {}, symmetry {}, teachers {}", gls::text_of(descriptor),
                     text_of(architecture), text_of(training), static_cast<int>(symmetry),
                     teachers);
}

std::string text_of(const Treatment& treatment) {
  const auto& [keep, noise, along_normal, estimate_normals] = treatment;
  return fmt::format("keep {} noise {} {} normals {}", keep, noise,
                     along_normal ? "along normals" : "every way",
                     estimate_normals ? "estimated" : "given");
}

std::string text_of(const CloudSet& set) {
  std::string text;
  for (const StudyCloud& cloud : set.clouds) text += cloud.digest + " ";
  return text;
}

std::string behaviour() {
  Digest digest;
  digest.add(std::string_view(kVersion));
  for (const shapes::Recipe& recipe : shapes::default_recipes(1)) {
    if (recipe.name != "icosahedron_0") continue;  // small, with points of every class
    PointCloud cloud = shapes::generate(recipe, 1).cloud;
    const auto given = detect::prepare(cloud);
    for (const auto& descriptor : descriptors_to_try()) {
      digest.add_values(std::span<const float>(detect::describe(given, descriptor).values));
    }
    try_networks(given, cloud, digest);
    cloud.normals.clear();
    digest.add_values(detect::prepare(cloud).normals);
  }
  return digest.hex();
}

}  // namespace pcednet::study
