// bench_adapting [--model FILE] [--seed N] CLOUD...: how well simulated users correct a model.
//
// A user paints balls of four spacings round random errors of the present prediction, with the true
// labels. After 1, 2, 4, 8 and 16 strokes the program trains as `pcednet annotate` does, once from
// nothing and once from the model, and prints the MCC of sharp-edge over the whole cloud.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "pcednet/core/error.h"
#include "pcednet/core/random.h"
#include "pcednet/eval/scores.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/gls/scales.h"
#include "workbench/annotate/learn/learn.h"

namespace pcednet::annotate {
namespace {

constexpr std::array<int, 5> kStrokes = {1, 2, 4, 8, 16};
constexpr double kReach = 4;  // of a stroke, in spacings

struct Labelled {
  PointCloud cloud = {};
  detect::PreparedCloud prepared = {};
  std::shared_ptr<const Described> described = {};
  double spacing = 0;

  Subject subject() const { return {{{*described, cloud.positions, prepared.curve}}}; }
};

/// Scores after each number of strokes in kStrokes; none where training was not possible yet.
using Curve = std::array<double, kStrokes.size()>;

std::unique_ptr<Labelled> read(const std::string& file, const gls::ScaleSpaceOptions& descriptor) {
  auto made = std::make_unique<Labelled>();
  made->cloud = formats::read_cloud(file).cloud;
  const auto& labels = made->cloud.labels;
  if (std::find(labels.begin(), labels.end(), kSharpEdge) == labels.end()) {
    throw Error(ErrorKind::kInsufficient, file + ": no point is labelled sharp-edge");
  }
  for (std::uint8_t& label : made->cloud.labels) {
    if (label == kBoundary) label = kNonEdge;  // which cannot be painted
  }
  made->prepared = detect::prepare(made->cloud);
  made->described = describe_once(made->prepared, descriptor, {});
  const std::vector<Vec3>& positions = made->cloud.positions;
  const std::vector<std::uint32_t>& curve = made->prepared.curve;
  made->spacing = gls::scale_range(positions, {}, [&] {
                    return gls::spacings_of_places(positions, curve);
                  }).s_min;
  return made;
}

double mcc(const Labelled& cloud, const std::vector<std::uint8_t>& found) {
  return eval::scores_of(eval::count_confusion(cloud.cloud.labels, found, eval::Positive::kSharp))
      .mcc;
}

/// One stroke round an unpainted error; none if there is no such error.
void correct(const Labelled& cloud, const std::vector<std::uint8_t>& found, Random& random,
             std::vector<std::uint8_t>& painted) {
  const auto& truth = cloud.cloud.labels;
  std::vector<std::size_t> wrong;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] != truth[i] && truth[i] != kUnlabelled && painted[i] == kUnlabelled) {
      wrong.push_back(i);
    }
  }
  if (wrong.empty()) return;
  const Vec3 centre = cloud.cloud.positions[wrong[random.index(wrong.size())]];
  for (std::size_t i = 0; i < painted.size(); ++i) {
    const double away = (cloud.cloud.positions[i] - centre).norm();
    if (away <= kReach * cloud.spacing) painted[i] = truth[i];
  }
}

/// The scores of a user who begins with the answers `found`.
Curve work(const Labelled& cloud, const Start* start, std::vector<std::uint8_t> found,
           std::uint64_t seed) {
  Random random(seed, 9);
  Curve curve = {};
  std::vector<std::uint8_t> painted(found.size(), kUnlabelled);
  int strokes = 0;
  for (std::size_t k = 0; k < kStrokes.size(); ++k) {
    for (; strokes < kStrokes[k]; ++strokes) correct(cloud, found, random, painted);
    try {
      found = learn("", cloud.subject(), painted, {}, start).found.classes;
      curve[k] = mcc(cloud, found);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kInsufficient) throw;  // one class alone, from nothing
    }
  }
  return curve;
}

std::string text_of(const Curve& curve, double share = 1) {
  std::string text;
  for (const double score : curve) text += fmt::format(" {:.3f}", score * share);
  return text;
}

void run(const std::string& model_file, std::uint64_t seed, const std::vector<std::string>& files) {
  const detect::EdgeModel model = detect::load_model(model_file);
  double before = 0, worst = 0;
  Curve from_nothing = {}, from_model = {};
  fmt::print("{:28} {:>8} start | after 1, 2, 4, 8, 16 strokes from nothing | from the model\n",
             "cloud", "points");
  for (const std::string& file : files) {
    const auto cloud = read(file, model.descriptor);
    const Start start = make_start(model, cloud->subject());
    const double at_first = mcc(*cloud, start.answer.classes);
    const std::vector<std::uint8_t> nothing(cloud->cloud.size(), kNonEdge);
    const Curve a = work(*cloud, nullptr, nothing, seed);
    const Curve b = work(*cloud, &start, start.answer.classes, seed);
    fmt::print("{:28} {:8} {:.3f} |{} |{}\n", file.substr(file.rfind('/') + 1), cloud->cloud.size(),
               at_first, text_of(a), text_of(b));
    std::fflush(stdout);
    before += at_first;
    for (std::size_t k = 0; k < kStrokes.size(); ++k) {
      from_nothing[k] += a[k];
      from_model[k] += b[k];
      worst = std::min(worst, b[k] - at_first);
    }
  }
  const double share = 1.0 / static_cast<double>(files.size());
  fmt::print("{:37} {:.3f} |{} |{}; worst of all {:+.3f}\n", "mean", before * share,
             text_of(from_nothing, share), text_of(from_model, share), worst);
}

}  // namespace
}  // namespace pcednet::annotate

int main(int count, char** arguments) {
  std::string model = PCEDNET_SOURCE_DIR "/models/general.safetensors";
  std::uint64_t seed = 1;
  std::vector<std::string> files;
  for (int i = 1; i < count; ++i) {
    const std::string word = arguments[i];
    if (word == "--model" && i + 1 < count) {
      model = arguments[++i];
    } else if (word == "--seed" && i + 1 < count) {
      seed = std::stoull(arguments[++i]);
    } else {
      files.push_back(word);
    }
  }
  if (files.empty()) {
    std::fprintf(stderr, "bench_adapting [--model FILE] [--seed N] LABELLED_CLOUD...\n");
    return 2;
  }
  try {
    pcednet::annotate::run(model, seed, files);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_adapting: %s\n", error.what());
    return 1;
  }
}
