#include "pcednet/detect/piece.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "pcednet/detect/outputs.h"
#include "pcednet/nn/predict.h"

namespace pcednet::detect {
namespace {

CloudTraits as_piece(CloudTraits traits) {
  traits.points = CloudTraits{}.points;
  return traits;
}

bool asks_for_pieces(const EdgeModel& model, const CloudTraits& traits) {
  return model.pieces && expert_for(model, traits) != expert_for(model, as_piece(traits));
}

bool is_piece(const nn::Model& pieces, std::span<const float> rows) {
  constexpr double kLeastShare = 1e-4;  // no point decides alone
  constexpr std::size_t kPieceOutput = 1;
  const std::vector<float> probabilities = nn::predict(pieces, rows);
  double sum = 0.0;
  for (std::size_t i = kPieceOutput; i < probabilities.size(); i += kPieceOutputs) {
    const double p =
        std::clamp(static_cast<double>(probabilities[i]), kLeastShare, 1.0 - kLeastShare);
    sum += std::log(p / (1.0 - p));
  }
  return sum > 0.0;
}

}  // namespace

CloudTraits traits_for(const EdgeModel& model, const PreparedCloud& cloud) {
  if (model.experts.empty()) return {};
  const CloudTraits traits = traits_of(cloud, model.descriptor);
  if (cloud.part || !asks_for_pieces(model, traits)) return traits;
  std::vector<float> rows;
  describe_rows(cloud, model.descriptor, [&](const auto&, std::span<const float> some) {
    rows.insert(rows.end(), some.begin(), some.end());
  });
  return is_piece(*model.pieces, rows) ? as_piece(traits) : traits;
}

CloudTraits traits_for(const EdgeModel& model, const DescribedCloud& cloud) {
  const bool asked = asks_for_pieces(model, cloud.traits);
  return asked && is_piece(*model.pieces, cloud.values) ? as_piece(cloud.traits) : cloud.traits;
}

void check_pieces(const EdgeModel& pieces, const gls::ScaleSpaceOptions& descriptor) {
  check_fits(pieces, descriptor, kPieceOutputs);
  check_classes(pieces, parse_classes("whole,piece"));
}

void join_pieces(EdgeModel& model, const EdgeModel& pieces) {
  check_pieces(pieces, model.descriptor);
  model.pieces = pieces.network;
}

}  // namespace pcednet::detect
