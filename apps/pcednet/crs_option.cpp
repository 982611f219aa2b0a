#include "crs_option.h"

#include <string>
#include <string_view>

#include "pcednet/core/error.h"
#include "pcednet/io/projection.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::app {
namespace {

/// The code of "EPSG:25832"; 0 if it is none.
int code_of(std::string_view word) {
  if (io::lower_case(word.substr(0, 5)) != "epsg:") return 0;
  return io::epsg_code(word.substr(5));
}

io::CoordinateSystem system_of_code(int epsg) {
  io::CoordinateSystem system{.epsg = epsg};
  if (!io::has_projections()) return system;
  std::string wkt = io::definition_of(system, io::WktVersion::k1);
  if (wkt.empty()) wkt = io::definition_of(system, io::WktVersion::k2);
  if (wkt.empty()) {
    throw Error(ErrorKind::kUsage,
                "--crs EPSG:" + std::to_string(epsg) + ": PROJ knows no such system");
  }
  system = io::coordinate_system_of_wkt(wkt);
  system.epsg = epsg;
  return system;
}

}  // namespace

CLI::Option* add_crs_option(CLI::App& command, std::optional<io::CoordinateSystem>& system) {
  return command
      .add_option_function<std::string>(
          "--crs", [&system](const std::string& word) { system = system_of_code(code_of(word)); },
          "The coordinate system, such as EPSG:25832, where the file does not name it")
      ->check(CLI::Validator(
          [](const std::string& word) {
            return code_of(word) > 0 ? "" : word + " is not a code such as EPSG:25832";
          },
          "EPSG:CODE"));
}

}  // namespace pcednet::app
