#pragma once

#include <string_view>

namespace pcednet::app {

/// The web page of `pcednet annotate`; empty if the program was built without it.
std::string_view annotate_page();

}  // namespace pcednet::app
