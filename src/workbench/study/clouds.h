#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pcednet/cloud/class_table.h"
#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"
#include "pcednet/eval/scores.h"

namespace pcednet::study {

/// A labelled cloud, and its identity.
struct StudyCloud {
  std::string name;
  std::string file;  ///< its file; empty if it was made in memory
  PointCloud cloud;
  std::string digest;  ///< of positions, normals and labels, in their order
  std::string places;  ///< of the positions, in any order
};

/// Throws Error(kind), naming `whose`, if classes are not edge classes or, by number, have other
/// names; their colours do not matter.
void check_edge_classes(const ClassTable& table, const std::string& whose, ErrorKind kind);

/// Throws Error(kInsufficient), naming it, if `cloud` has no points or no labels, or names classes
/// that are not edge classes.
StudyCloud make_study_cloud(const std::string& name, const std::string& file, PointCloud cloud);

struct CloudSet {
  std::string name;
  eval::Positive positive = eval::Positive::kSharp;  ///< the classes that count as edge in it
  std::vector<StudyCloud> clouds = {};
};

/// kEdge if a cloud has a point of the smooth-edge class, otherwise kSharp.
eval::Positive positive_of(const std::vector<StudyCloud>& clouds);

/// The data of the experiments.
struct StudyData {
  std::shared_ptr<const CloudSet> training;
  std::vector<std::shared_ptr<const CloudSet>> tests = {};
};

}  // namespace pcednet::study
