#pragma once

#include <string_view>

namespace pcednet::app {

/// The web page that `pcednet report` fills in; empty if the program was built without it.
std::string_view report_page();

/// The web page of `pcednet annotate`; likewise.
std::string_view annotate_page();

}  // namespace pcednet::app
