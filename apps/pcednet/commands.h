#pragma once

#include <CLI/CLI.hpp>

#include "common.h"

namespace pcednet::app {

// Each subcommand adds itself to the command line; its callback does the work and reports failure
// by throwing pcednet::Error. One file per subcommand, in commands/.

}  // namespace pcednet::app
