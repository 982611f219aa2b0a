#include "pcednet/io/projection.h"

#ifdef PCEDNET_WITH_PROJ
#include <fmt/format.h>
#include <proj.h>

#include <cmath>
#include <memory>
#endif

namespace pcednet::io {

#ifdef PCEDNET_WITH_PROJ

namespace {

/// A PROJ system, and the objects it depends on.
struct Projected {
  std::unique_ptr<PJ_CONTEXT, decltype(&proj_context_destroy)> context{proj_context_create(),
                                                                       proj_context_destroy};
  std::unique_ptr<PJ, decltype(&proj_destroy)> system{nullptr, proj_destroy};
};

Projected look_up(const CoordinateSystem& system) {
  std::string definition = system.wkt;
  if (definition.empty() && system.epsg > 0) {
    definition = fmt::format("EPSG:{}", system.epsg);
    if (system.vertical_epsg > 0) definition += fmt::format("+{}", system.vertical_epsg);
  }
  Projected found;
  if (definition.empty() || !found.context) return found;
  proj_log_level(found.context.get(), PJ_LOG_NONE);
  proj_context_set_enable_network(found.context.get(), 0);
  found.system.reset(proj_create(found.context.get(), definition.c_str()));
  if (found.system && !proj_is_crs(found.system.get())) found.system.reset();
  return found;
}

}  // namespace

bool has_projections() {
  return true;
}

std::string definition_of(const CoordinateSystem& system, WktVersion version) {
  const Projected found = look_up(system);
  if (!found.system) return {};
  const char* const options[] = {"MULTILINE=NO", nullptr};
  const PJ_WKT_TYPE type = version == WktVersion::k1 ? PJ_WKT1_GDAL : PJ_WKT2_2019;
  const char* text = proj_as_wkt(found.context.get(), found.system.get(), type, options);
  return text ? text : "";
}

std::optional<std::vector<std::array<double, 2>>> to_wgs84(
    const CoordinateSystem& system, std::vector<std::array<double, 2>> points) {
  const Projected found = look_up(system);
  if (!found.system) return std::nullopt;
  PJ_CONTEXT* context = found.context.get();
  const auto own = [](PJ* object) {
    return std::unique_ptr<PJ, decltype(&proj_destroy)>(object, proj_destroy);
  };
  const auto wgs84 = own(proj_create(context, "EPSG:4326"));
  if (!wgs84) return std::nullopt;
  const auto exact = own(
      proj_create_crs_to_crs_from_pj(context, found.system.get(), wgs84.get(), nullptr, nullptr));
  // East before north, for any order of the systems' axes.
  const auto change = own(exact ? proj_normalize_for_visualization(context, exact.get()) : nullptr);
  if (!change) return std::nullopt;
  for (std::array<double, 2>& point : points) {
    const PJ_COORD there =
        proj_trans(change.get(), PJ_FWD, proj_coord(point[0], point[1], 0.0, HUGE_VAL));
    point = {there.xy.x, there.xy.y};
    if (!std::isfinite(point[0]) || !std::isfinite(point[1])) return std::nullopt;
  }
  return points;
}

#else

bool has_projections() {
  return false;
}

std::string definition_of(const CoordinateSystem&, WktVersion) {
  return {};
}

std::optional<std::vector<std::array<double, 2>>> to_wgs84(const CoordinateSystem&,
                                                           std::vector<std::array<double, 2>>) {
  return std::nullopt;
}

#endif

}  // namespace pcednet::io
