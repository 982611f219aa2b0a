#include "pcednet/eval/scores.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.h"
#include "bindings.h"
#include "job.h"
#include "pcednet/core/named.h"
#include "pcednet/eval/line_scores.h"
#include "pcednet/eval/report.h"
#include "pcednet/io/drawing/read_curves.h"

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

/// The JSON of one cloud, in the frame of its points or, without them, of the true curves.
std::string score_lines(const std::vector<lines::Curve>& found,
                        const std::vector<lines::Curve>& truth,
                        const OptionalArray<double>& cloud) {
  std::string scores;
  run_job({py::none()}, [&](const Progress*) {
    const eval::LineFrame frame =
        cloud ? eval::frame_of_cloud(vectors(*cloud)) : eval::frame_of_curves(truth);
    scores = eval::to_json({{"", eval::score_lines(found, truth, frame)}});
  });
  return scores;
}

}  // namespace

void add_scores(py::module_& module) {
  module.def("none_is_positive", none_is_positive);
  module.def("evaluate", evaluate);
  module.def("score_lines", score_lines);
  module.def("read_curves", io::read_curves);
}

}  // namespace pcednet::python
