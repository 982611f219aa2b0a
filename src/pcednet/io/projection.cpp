#include "pcednet/io/projection.h"

#include <fmt/format.h>

#include "pcednet/core/error.h"
#include "pcednet/io/text_scan.h"

#ifdef PCEDNET_WITH_PROJ
#include <proj.h>

#include <cmath>
#include <memory>
#endif
#ifdef PCEDNET_PROJ_LIBRARY
#include <dlfcn.h>
#endif

namespace pcednet::io {

#ifdef PCEDNET_WITH_PROJ

namespace {

/// The functions of PROJ that are used here.
struct ProjFunctions {
  decltype(&proj_context_create) context_create;
  decltype(&proj_context_destroy) context_destroy;
  decltype(&proj_context_set_enable_network) context_set_enable_network;
  decltype(&proj_log_level) log_level;
  decltype(&proj_create) create;
  decltype(&proj_create_crs_to_crs_from_pj) create_crs_to_crs_from_pj;
  decltype(&proj_normalize_for_visualization) normalize_for_visualization;
  decltype(&proj_is_crs) is_crs;
  decltype(&proj_as_wkt) as_wkt;
  decltype(&proj_trans) trans;
  decltype(&proj_destroy) destroy;
  decltype(&proj_identify) identify;
  decltype(&proj_int_list_destroy) int_list_destroy;
  decltype(&proj_list_get_count) list_get_count;
  decltype(&proj_list_get) list_get;
  decltype(&proj_list_destroy) list_destroy;
  decltype(&proj_get_id_code) get_id_code;
};

#ifdef PCEDNET_PROJ_LIBRARY

template <typename Function>
bool load_function(void* library, const char* name, Function*& function) {
  function = reinterpret_cast<Function*>(dlsym(library, name));
  return function != nullptr;
}

/// Loads PROJ when it is first needed: with the thirty libraries that it needs, that takes longer
/// than many a command. Null if it is not there.
const ProjFunctions* proj() {
  static const std::optional<ProjFunctions> functions = []() -> std::optional<ProjFunctions> {
    void* library = dlopen(PCEDNET_PROJ_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    ProjFunctions f{};
    const bool found =
        library && load_function(library, "proj_context_create", f.context_create) &&
        load_function(library, "proj_context_destroy", f.context_destroy) &&
        load_function(library, "proj_context_set_enable_network", f.context_set_enable_network) &&
        load_function(library, "proj_log_level", f.log_level) &&
        load_function(library, "proj_create", f.create) &&
        load_function(library, "proj_create_crs_to_crs_from_pj", f.create_crs_to_crs_from_pj) &&
        load_function(library, "proj_normalize_for_visualization", f.normalize_for_visualization) &&
        load_function(library, "proj_is_crs", f.is_crs) &&
        load_function(library, "proj_as_wkt", f.as_wkt) &&
        load_function(library, "proj_trans", f.trans) &&
        load_function(library, "proj_destroy", f.destroy) &&
        load_function(library, "proj_identify", f.identify) &&
        load_function(library, "proj_int_list_destroy", f.int_list_destroy) &&
        load_function(library, "proj_list_get_count", f.list_get_count) &&
        load_function(library, "proj_list_get", f.list_get) &&
        load_function(library, "proj_list_destroy", f.list_destroy) &&
        load_function(library, "proj_get_id_code", f.get_id_code);
    return found ? std::optional(f) : std::nullopt;
  }();
  return functions ? &*functions : nullptr;
}

#else

const ProjFunctions* proj() {
  static const ProjFunctions functions = {proj_context_create,
                                          proj_context_destroy,
                                          proj_context_set_enable_network,
                                          proj_log_level,
                                          proj_create,
                                          proj_create_crs_to_crs_from_pj,
                                          proj_normalize_for_visualization,
                                          proj_is_crs,
                                          proj_as_wkt,
                                          proj_trans,
                                          proj_destroy,
                                          proj_identify,
                                          proj_int_list_destroy,
                                          proj_list_get_count,
                                          proj_list_get,
                                          proj_list_destroy,
                                          proj_get_id_code};
  return &functions;
}

#endif

struct Destroy {
  void operator()(PJ_CONTEXT* context) const { proj()->context_destroy(context); }
  void operator()(PJ* object) const { proj()->destroy(object); }
  void operator()(PJ_OBJ_LIST* list) const { proj()->list_destroy(list); }
  void operator()(int* numbers) const { proj()->int_list_destroy(numbers); }
};
using ProjContext = std::unique_ptr<PJ_CONTEXT, Destroy>;
using ProjObject = std::unique_ptr<PJ, Destroy>;

/// A PROJ system, and the objects it depends on.
struct Projected {
  ProjContext context = {};
  ProjObject system = {};
};

Projected look_up(const CoordinateSystem& system) {
  std::string definition = system.wkt;
  if (definition.empty() && system.epsg > 0) {
    definition = fmt::format("EPSG:{}", system.epsg);
    if (system.vertical_epsg > 0) definition += fmt::format("+{}", system.vertical_epsg);
  }
  Projected found;
  if (definition.empty() || !proj()) return found;
  found.context.reset(proj()->context_create());
  if (!found.context) return found;
  proj()->log_level(found.context.get(), PJ_LOG_NONE);
  proj()->context_set_enable_network(found.context.get(), 0);
  found.system.reset(proj()->create(found.context.get(), definition.c_str()));
  if (found.system && !proj()->is_crs(found.system.get())) found.system.reset();
  return found;
}

}  // namespace

bool is_of_heights_alone(const CoordinateSystem& system) {
  if (system.wkt.empty()) return system.epsg == 0 && system.vertical_epsg > 0;
  return lower_case(system.wkt).starts_with("vert");
}

bool has_projections() {
  return proj() != nullptr;
}

std::string definition_of(const CoordinateSystem& system, WktVersion version) {
  const Projected found = look_up(system);
  if (!found.system) return {};
  const char* const options[] = {"MULTILINE=NO", nullptr};
  const PJ_WKT_TYPE type = version == WktVersion::k1 ? PJ_WKT1_GDAL : PJ_WKT2_2019;
  const char* text = proj()->as_wkt(found.context.get(), found.system.get(), type, options);
  return text ? text : "";
}

int code_of_definition(const std::string& wkt) {
  constexpr int kSure = 100;
  const Projected found = look_up({.wkt = wkt});
  if (!found.system) return 0;
  PJ_CONTEXT* context = found.context.get();
  int* how_sure = nullptr;
  const std::unique_ptr<PJ_OBJ_LIST, Destroy> matches(
      proj()->identify(context, found.system.get(), "EPSG", nullptr, &how_sure));
  const std::unique_ptr<int, Destroy> sure(how_sure);
  if (!matches || proj()->list_get_count(matches.get()) == 0 || *sure < kSure) return 0;
  const ProjObject best(proj()->list_get(context, matches.get(), 0));
  const char* code = best ? proj()->get_id_code(best.get(), 0) : nullptr;
  return code ? epsg_code(code) : 0;
}

std::optional<std::vector<std::array<double, 2>>> to_wgs84(
    const CoordinateSystem& system, std::vector<std::array<double, 2>> points) {
  const Projected found = look_up(system);
  if (!found.system) return std::nullopt;
  PJ_CONTEXT* context = found.context.get();
  const ProjObject wgs84(proj()->create(context, "EPSG:4326"));
  if (!wgs84) return std::nullopt;
  const ProjObject exact(proj()->create_crs_to_crs_from_pj(context, found.system.get(), wgs84.get(),
                                                           nullptr, nullptr));
  // East before north, for any order of the systems' axes.
  const ProjObject change(exact ? proj()->normalize_for_visualization(context, exact.get())
                                : nullptr);
  if (!change) return std::nullopt;
  for (std::array<double, 2>& point : points) {
    const PJ_COORD here{{point[0], point[1], 0.0, HUGE_VAL}};
    const PJ_COORD there = proj()->trans(change.get(), PJ_FWD, here);
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

int code_of_definition(const std::string&) {
  return 0;
}

std::optional<std::vector<std::array<double, 2>>> to_wgs84(const CoordinateSystem&,
                                                           std::vector<std::array<double, 2>>) {
  return std::nullopt;
}

#endif

CoordinateSystem system_of_code(int epsg, int heights) {
  const auto refuse = [&](const std::string& why) {
    const std::string more = heights == 0 ? "" : fmt::format("+{}", heights);
    throw Error(ErrorKind::kUsage, fmt::format("EPSG:{}{}: {}", epsg, more, why));
  };
  const auto is_code = [](int code) { return code >= kLeastEpsgCode && code <= kMostEpsgCode; };
  if (!is_code(epsg) || (heights != 0 && !is_code(heights))) {
    refuse(fmt::format("no code of a coordinate system, which are from {} to {}", kLeastEpsgCode,
                       kMostEpsgCode));
  }
  CoordinateSystem system{.epsg = epsg, .vertical_epsg = heights};
  if (!has_projections()) return system;
  std::string wkt = definition_of(system, WktVersion::k1);
  if (wkt.empty()) wkt = definition_of(system, WktVersion::k2);
  if (wkt.empty()) refuse("PROJ knows no such system");
  system = coordinate_system_of_wkt(wkt);
  if (is_of_heights_alone(system)) {
    refuse("a system of heights alone, which has no x and y");
  }
  system.epsg = epsg;
  system.vertical_epsg = heights;
  return system;
}

}  // namespace pcednet::io
