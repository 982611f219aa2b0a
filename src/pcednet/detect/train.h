#pragma once

#include <functional>
#include <span>
#include <string>

#include "pcednet/detect/model.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/nn/train.h"

namespace pcednet::detect {

/// A cloud to learn from. The spans and the cloud behind them must outlive the training.
struct TrainingCloud {
  std::string name;
  PreparedCloud cloud;
  std::span<const std::uint8_t> labels;  ///< per point, of the options' table; kUnlabelled is left
                                         ///< out, kBoundary counts as kNonEdge
};

/// The labels of a cloud, as in TrainingCloud.
struct NamedLabels {
  std::string name;
  std::span<const std::uint8_t> labels;
};

struct TrainOptions {
  gls::ScaleSpaceOptions descriptor;  ///< if not `rounded`, that of training alone: models round
  nn::Architecture architecture;      ///< scales and features are set from `descriptor`
  /// The classes that labels index. With own classes the network has an output for each class that
  /// occurs, regardless of the architecture.
  ClassTable table = edge_classes();
  nn::TrainOptions training;  ///< sign rule and class names are set from the rest
  nn::Symmetry symmetry = nn::Symmetry::kAverage;  ///< flipped normals change no answer
  int teachers = 0;                                ///< networks to train first and distil from
  bool context = false;  ///< train a context network too, where clouds are given
};

/// Throws Error(kInsufficient) if no network can learn from the labels: naming the cloud if it has
/// no labelled point, otherwise the class if no point of any cloud has it.
void check_labels(std::span<const NamedLabels> clouds, const TrainOptions& options);

/// A scale-space matrix row and a label per labelled point of the clouds, cloud by cloud, each in
/// an order independent of the numbering of its points.
struct Samples {
  gls::ScaleSpaceOptions descriptor = {};
  std::vector<float> values = {};         ///< samples x scales x features
  std::vector<std::uint8_t> labels = {};  ///< of the options' table
  std::size_t clouds = 0, points = 0;     ///< the clouds, and all their points
  std::vector<std::string> notes = {};    ///< for the user, one sentence each
};

/// Describes every labelled point.
/// Throws Error(kInsufficient), naming the cloud, if it has no labelled point.
Samples make_samples(std::span<const TrainingCloud> clouds,
                     const gls::ScaleSpaceOptions& descriptor, const Progress* progress = nullptr,
                     const ClassTable& table = edge_classes());

struct TrainedModel {
  EdgeModel model;
  bool cancelled = false;
  int epochs = 0;          ///< completed; after 0 epochs the model is not worth keeping
  bool validated = false;  ///< the best epoch was kept; otherwise the last, as nothing was held out
  bool adapted = false;    ///< from another model, which holds nothing out
  std::vector<std::string> notes = {};  ///< for the user, one sentence each
  /// Why the first network left nothing for a context network to learn from, though one was wanted.
  std::string no_context = {};
};

/// Describes the clouds and trains a network on them. `name` goes into the model. The same clouds,
/// options and seed give the same bytes for any number of threads. With two classes, smooth-edge
/// counts as non-edge. A cancel during the training proper returns the best model so far; see
/// TrainedModel::cancelled.
TrainedModel train(const std::string& name, std::span<const TrainingCloud> clouds,
                   const TrainOptions& options,
                   const std::function<void(const nn::EpochReport&)>& on_epoch = {},
                   const Progress* progress = nullptr);

/// The same from descriptions made before, to train several networks on them; their descriptor
/// replaces that in `options`.
TrainedModel train(const std::string& name, const Samples& samples, const TrainOptions& options,
                   const std::function<void(const nn::EpochReport&)>& on_epoch = {},
                   const Progress* progress = nullptr);

}  // namespace pcednet::detect
