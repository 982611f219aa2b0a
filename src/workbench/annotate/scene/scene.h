#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/detect/boundary.h"
#include "pcednet/detect/points/prepare.h"
#include "workbench/annotate/project/project.h"
#include "workbench/annotate/scene/described.h"
#include "workbench/annotate/scene/file_classes.h"
#include "workbench/annotate/scene/layout.h"
#include "workbench/annotate/scene/select.h"

namespace pcednet::annotate {

/// A cloud with all data for viewing and painting; immutable.
struct Scene {
  InputIdentity input = {};
  PointCloud cloud = {};
  std::vector<std::string> warnings = {};
  FileClasses labels = {}, las_classes = {};  ///< see file_labels() and las_classes()
  detect::PreparedCloud prepared = {};
  BoundingBox bounds = {};
  Vec3 origin = Vec3::Zero();  ///< what local coordinates are relative to
  double spacing = 0.0;        ///< the mean of the middle half: no far point changes it
  std::vector<detect::BoundaryPoint> boundary = {};
  Layout layout = {};
  std::unique_ptr<const Selector> selector = {};
};

/// Reads and prepares a cloud. Throws as reading and preparing do.
std::shared_ptr<const Scene> load_scene(const std::filesystem::path& input,
                                        const Progress* progress = nullptr);

/// What the user should know of it: the warnings and the notes of preparing it.
std::vector<std::string> notes_of(const Scene& scene);

/// A model's prediction for a cloud, with its boundary.
struct Prediction {
  detect::EdgeModel model = {};
  detect::Classification result = {};
  /// The probability of the chosen class; 1 for boundary, which no network decides; 0 without a
  /// class.
  std::vector<float> confidence = {};
};

/// The prediction from `found`, the result of `model` for the scene's cloud.
std::shared_ptr<const Prediction> make_prediction(const Scene& scene, detect::EdgeModel model,
                                                  detect::Classification found);

/// 0 ... 1 as 0 ... 255.
std::uint8_t byte_of(float share);

/// A byte per point of a node, for colouring: feature `feature` at scale `scale` of a description.
/// phi is mapped from 0 ... 1 to 0 ... 255, any other value x by (1 + x / (1 + |x|)) / 2; 0 where
/// there is no description. Throws NotFound if there is no such feature or scale.
std::vector<std::uint8_t> feature_bytes(const Described& described,
                                        std::span<const std::uint32_t> points, int feature,
                                        int scale);

}  // namespace pcednet::annotate
