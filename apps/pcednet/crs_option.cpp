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

}  // namespace

CLI::Option* add_crs_option(CLI::App& command, std::optional<io::CoordinateSystem>& system) {
  return command
      .add_option_function<std::string>(
          "--crs",
          [&system](const std::string& word) {
            with_name_in_errors("--crs", [&] { system = io::system_of_code(code_of(word)); });
          },
          "The coordinate system, such as EPSG:25832, where the file does not name it")
      ->check(CLI::Validator(
          [](const std::string& word) {
            return code_of(word) > 0 ? "" : word + " is not a code such as EPSG:25832";
          },
          "EPSG:CODE"));
}

}  // namespace pcednet::app
