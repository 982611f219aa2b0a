#include "pcednet/eval/scores.h"

#include <pybind11/stl.h>

#include "arrays.h"
#include "bindings.h"
#include "pcednet/core/error.h"

namespace pcednet::python {
namespace {

eval::Positive positive_named(const std::string& name) {
  if (name == "sharp") return eval::Positive::kSharp;
  if (name == "edge") return eval::Positive::kEdge;
  if (name == "boundary") return eval::Positive::kBoundary;
  throw Error(ErrorKind::kUsage, "positive \"" + name + "\": there are sharp, edge, boundary");
}

/// Confusion counts and scores, by name.
py::dict evaluate(const Array<std::uint8_t>& truth, const Array<std::uint8_t>& predicted,
                  const std::string& positive) {
  const eval::ConfusionCounts counts =
      eval::count_confusion(numbers(truth), numbers(predicted), positive_named(positive));
  const eval::Scores scores = eval::scores_of(counts);
  py::dict result;
  result["precision"] = scores.precision;
  result["recall"] = scores.recall;
  result["mcc"] = scores.mcc;
  result["f1"] = scores.f1;
  result["accuracy"] = scores.accuracy;
  result["iou"] = scores.iou;
  result["tp"] = counts.tp;
  result["fp"] = counts.fp;
  result["tn"] = counts.tn;
  result["fn"] = counts.fn;
  return result;
}

}  // namespace

void add_scores(py::module_& module) {
  module.def("evaluate", evaluate);
}

}  // namespace pcednet::python
