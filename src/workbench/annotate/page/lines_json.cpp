#include <array>
#include <numbers>

#include "pcednet/core/json.h"
#include "workbench/annotate/page/json.h"

namespace pcednet::annotate {
namespace {

/// By Decision.
constexpr std::array kDecisions = {"open", "accepted", "rejected"};

Json numbers_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json line_of(const lines::Curve& curve, Decision decision, const Scene& scene) {
  const CurveView view = view_of(curve, scene);
  Json path = Json::array();
  for (const Vec3& vertex : view.path) {
    for (const double x : vertex) path.push_back(x);
  }
  return {{"kind", lines::name_of(curve.kind)},
          {"class", curve.edge_class},
          {"length", lines::length_of(curve)},
          {"confidence", curve.confidence},
          {"angle", curve.dihedral_angle * 180.0 / std::numbers::pi},
          {"points", curve.support},
          {"decision", decision_name(decision)},
          {"middle", numbers_of(view.middle)},
          {"normal", numbers_of(view.normal)},
          {"path", std::move(path)}};
}

}  // namespace

const char* decision_name(Decision decision) {
  return kDecisions[static_cast<std::size_t>(decision)];
}

std::string to_json(const LinesView& view) {
  const LineReview& review = view.review;
  Json json = {{"version", review.version},
               {"prediction_version", review.prediction_version},
               {"searching", review.is_searching},
               {"lines", Json::array()}};
  if (view.cloud > 0) json["cloud"] = view.cloud;
  for (std::size_t i = 0; i < review.decisions.size(); ++i) {
    json["lines"].push_back(line_of((*review.curves)[i], review.decisions[i], *view.scene));
  }
  return to_text(json);
}

}  // namespace pcednet::annotate
