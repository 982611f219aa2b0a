// Writes a small E57 file to stdout: two scans, a pose, fields of many kinds; one packet a scan and
// no index, since web-e57 reads no other.
#include <iostream>

#include "io/e57/e57_writer.h"

int main() {
  using namespace pcednet::io;
  const E57TestScan first{
      "<name type=\"String\">a</name><pose type=\"Structure\"><rotation type=\"Structure\">"
      "<w type=\"Float\">0.6</w><x type=\"Float\">0.8</x><y type=\"Float\"/><z type=\"Float\"/>"
      "</rotation><translation type=\"Structure\"><x type=\"Float\">2600000</x>"
      "<y type=\"Float\"/><z type=\"Float\"/></translation></pose>"
      "<colorLimits type=\"Structure\"><colorRedMinimum type=\"Integer\"/>"
      "<colorRedMaximum type=\"Integer\">1000</colorRedMaximum>"
      "<colorGreenMinimum type=\"Integer\"/>"
      "<colorGreenMaximum type=\"Integer\">255</colorGreenMaximum>"
      "<colorBlueMinimum type=\"Integer\"/>"
      "<colorBlueMaximum type=\"Integer\">255</colorBlueMaximum></colorLimits>",
      {e57_double("cartesianX", {1, 2, 3}), e57_single("cartesianY", {1, 2, 3}),
       e57_integer("cartesianZ", -1, 500, {1, 2, 3}, "type=\"ScaledInteger\" scale=\"0.5\""),
       e57_integer("cartesianInvalidState", 0, 2, {0, 1, 0}),
       e57_integer("colorRed", 0, 1000, {1, 2, 3}), e57_integer("colorGreen", 0, 255, {1, 2, 3}),
       e57_integer("colorBlue", 0, 255, {1, 2, 3}), e57_single("nor:normalX", {1, 0, 0}),
       e57_single("nor:normalY", {0, 1, 0}), e57_single("nor:normalZ", {0, 0, 1}),
       e57_integer("rowIndex", 0, 5, {0, 1, 2})},
      3};
  const E57TestScan second{
      "",
      {e57_double("sphericalRange", {1, 2}), e57_double("sphericalAzimuth", {0, 1}),
       e57_double("sphericalElevation", {0, 1}), e57_single("intensity", {0.5F, 1}),
       e57_integer("rowIndex", 0, 7, {0, 7})},
      2};
  std::cout << e57_file({first, second}, 1000, false);
}
