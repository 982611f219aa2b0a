#pragma once

#include <CLI/CLI.hpp>

#include "common.h"

namespace pcednet::app {

// Each subcommand adds itself to the command line; its callback does the work and reports failure
// by throwing pcednet::Error. One file per subcommand, in commands/.

void add_classify(CLI::App& app, Common& common);
void add_lines(CLI::App& app, Common& common);
void add_tiles(CLI::App& app, Common& common);
void add_train(CLI::App& app, Common& common);
void add_evaluate(CLI::App& app, Common& common);
void add_describe(CLI::App& app, Common& common);
void add_generate(CLI::App& app, Common& common);
void add_normals(CLI::App& app, Common& common);
void add_info(CLI::App& app, Common& common);
void add_convert(CLI::App& app, Common& common);
void add_study(CLI::App& app, Common& common);
void add_report(CLI::App& app, Common& common);
void add_annotate(CLI::App& app, Common& common);

// Commands of `tiles` with a file of their own.
void add_tiles_plan(CLI::App& tiles, Common& common);
void add_tiles_status(CLI::App& tiles, Common& common);

}  // namespace pcednet::app
