#include "pcednet/eval/scores.h"

#include <pybind11/stl.h>

#include "arrays.h"
#include "bindings.h"
#include "named.h"
#include "pcednet/eval/score_columns.h"

namespace pcednet::python {
namespace {

/// Confusion counts and scores, by name.
py::dict evaluate(const Array<std::uint8_t>& truth, const Array<std::uint8_t>& predicted,
                  const std::string& positive) {
  const eval::ConfusionCounts counts = eval::count_confusion(
      numbers(truth), numbers(predicted), named(eval::kPositives, "positive", positive));
  py::dict result;
  eval::put(result, eval::scores_of(counts));
  result["tp"] = counts.tp;
  result["fp"] = counts.fp;
  result["tn"] = counts.tn;
  result["fn"] = counts.fn;
  return result;
}

std::string none_is_positive(std::size_t smooth, std::size_t sharp, const std::string& positive) {
  return eval::none_is_positive(smooth, sharp, named(eval::kPositives, "positive", positive));
}

}  // namespace

void add_scores(py::module_& module) {
  module.def("none_is_positive", none_is_positive);
  module.def("evaluate", evaluate);
}

}  // namespace pcednet::python
