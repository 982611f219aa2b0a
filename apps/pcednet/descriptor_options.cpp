#include "descriptor_options.h"

#include <fmt/format.h>

#include "common.h"
#include "number_options.h"
#include "pcednet/gls/scales.h"

namespace pcednet::app {
namespace {

const Choices<nn::Symmetry> kSymmetries = {{"average", nn::Symmetry::kAverage},
                                           {"canonical", nn::Symmetry::kCanonical},
                                           {"none", nn::Symmetry::kNone}};

Choices<gls::FeatureSet> feature_sets() {
  Choices<gls::FeatureSet> choices;
  for (const gls::FeatureSet set : gls::feature_sets()) {
    choices.emplace_back(std::to_string(gls::feature_count(set)), set);
  }
  return choices;
}

Choices<gls::Reconstruction> reconstructions() {
  Choices<gls::Reconstruction> choices;
  for (const std::string_view name : gls::reconstruction_names()) {
    choices.emplace_back(name, *gls::reconstruction_of(name));
  }
  return choices;
}

}  // namespace

void add_descriptor_options(CLI::App& command, gls::ScaleSpaceOptions& options) {
  command.add_option("--scales", options.scales, "Scales: 4, 8, 16, 32, 64 or 128")
      ->capture_default_str()
      ->check(CLI::IsMember({4, 8, 16, 32, 64, 128}));
  add_choice(command, "--features", options.features, feature_sets(), "Numbers per scale");
  add_choice(command, "--reconstruction", options.reconstruction, reconstructions(),
             "Surface to fit: sphere or plane, with (-mls) or without projection");
  add_gate_options(command, options);
  add_engine_option(command, options);
  add_scale_range_options(command, options);
  command
      .add_option("--s-max-ratio", options.range.s_max_ratio,
                  "Largest scale over the smallest, in place of 10 % of the diagonal (0: off)")
      ->capture_default_str()
      ->check(number_from_0());
}

void add_gate_options(CLI::App& command, gls::ScaleSpaceOptions& options) {
  const CLI::Validator cosine =
      number("a number from -1 to 1", [](double v) { return v >= -1.0 && v <= 1.0; });
  command
      .add_option("--gate", options.side_gate,
                  "Leave out neighbours whose normal has a cosine below this with the point's own, "
                  "such as the far side of thin walls (-1 to 1; default: off)")
      ->check(cosine);
  command
      .add_option("--second-gate", options.second_gate,
                  "Describe with a second gate as well: twice the numbers per scale")
      ->check(cosine);
}

void add_scale_range_options(CLI::App& command, gls::ScaleSpaceOptions& options) {
  command
      .add_option("--s-min", options.range.s_min,
                  "Smallest scale, in the unit of the cloud (0: from the cloud and, if there is "
                  "one, the model)")
      ->capture_default_str()
      ->check(number_from_0());
  command
      .add_option("--s-max", options.range.s_max,
                  "Largest scale, in the unit of the cloud (0: from the cloud and, if there is "
                  "one, the model)")
      ->capture_default_str()
      ->check(number_from_0());
}

void add_engine_option(CLI::App& command, gls::ScaleSpaceOptions& options) {
  command.add_flag_callback(
      "--exact", [&options] { options.engine = gls::Engine::kExact; },
      "Describe with exact neighbourhoods in double precision (slow)");
}

void check_scales(const std::filesystem::path& file, const BoundingBox& box,
                  const gls::ScaleSpaceOptions& options) {
  const std::string note = gls::note_on_extent(options, box.diagonal(), file.string() + ": ",
                                               {.s_min = "--s-min", .s_max = "--s-max"});
  if (!note.empty()) warn(note);
}

void add_network_options(CLI::App& command, detect::TrainOptions& options) {
  nn::Architecture& architecture = options.architecture;
  add_choice(command, "--network", architecture.kind, nn::kNetworkKinds, "Architecture");
  command
      .add_option("--classes", architecture.classes,
                  "3: non-edge, smooth-edge, sharp-edge; 2: sharp-edge and all other points")
      ->capture_default_str()
      ->check(CLI::IsMember({2, 3}));
  command
      .add_option("--width", architecture.width, "Neurons per pair of scales (0: as in the paper)")
      ->capture_default_str()
      ->transform(whole_number(0, 4096));
  add_choice(command, "--symmetry", options.symmetry, kSymmetries,
             "Symmetry under flipped normals: average, canonical (half the work) or none");
  command.add_flag("--context", options.context,
                   "Also train a context network, which refines the result from the predictions "
                   "around each point");
}

}  // namespace pcednet::app
