#include "workbench/study/keys.h"

#include <fmt/format.h>

#include "pcednet/core/digest.h"
#include "pcednet/core/processor.h"
#include "pcednet/io/input_file.h"

namespace pcednet::study {
namespace {

// The structured bindings below name every member, so that a new one does not compile before it
// has its place in the text.

std::string text_of_network(const nn::Architecture& architecture) {
  const auto& [kind, scales, features, classes, width, hidden] = architecture;
  // Scales and features are the descriptor's.
  static_cast<void>(scales), static_cast<void>(features);
  return fmt::format("network {} classes {} width {} hidden {}", static_cast<int>(kind), classes,
                     width, hidden);
}

std::string text_of_training(const nn::TrainOptions& options) {
  const auto& [optimiser, learning_rate, anneal, momentum, epochs, batch, balance, least_per_epoch,
               most_per_epoch, even_validation, held_out, standardise, sign_rule, class_names,
               start, seed] = options;
  // The runner has no model to start from; the signs and the names of the classes follow from the
  // rest.
  static_cast<void>(start), static_cast<void>(class_names), static_cast<void>(sign_rule);
  return fmt::format(
      "optimiser {} rate {} anneal {} momentum {} epochs {} batch {} balance {} least {} most {} "
      "validation {} held out {} standardise {} seed {}",
      static_cast<int>(optimiser), learning_rate, anneal, momentum, epochs, batch, balance,
      least_per_epoch, most_per_epoch, even_validation, held_out, standardise, seed);
}

}  // namespace

std::string text_of(const detect::TrainOptions& options) {
  const auto& [descriptor, architecture, table, training, symmetry, teachers, context] = options;
  static_cast<void>(table);  // a study is of edge classes
  return fmt::format("{}, {}, {}, symmetry {}, teachers {}{}", gls::text_of(descriptor),
                     text_of_network(architecture), text_of_training(training),
                     static_cast<int>(symmetry), teachers, context ? ", context" : "");
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

std::string this_program() {
  return fmt::format("{} level {}", Digest().add(io::InputFile("/proc/self/exe").text()).hex(),
                     static_cast<int>(instruction_set()));
}

}  // namespace pcednet::study
