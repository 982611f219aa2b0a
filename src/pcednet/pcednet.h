#pragma once

/// Edges of 3D point clouds, for programs that hold their points in memory:
///
///     pcednet::PointCloud cloud;
///     cloud.positions = ...;  // and cloud.normals, if there are any
///     const auto model = pcednet::detect::load_model("general.safetensors");
///     const auto prepared = pcednet::detect::prepare(cloud, {.average_noise = true});
///     auto found = pcednet::detect::classify(prepared, model);
///     pcednet::detect::mark_boundary(prepared, found);  // where the surface ends
///     const auto curves = pcednet::lines::find_lines({prepared.positions, prepared.normals,
///                                                     found.classes, found.p_sharp,
///                                                     found.p_smooth});
///     const auto all = pcednet::detect::of_all_points(prepared, found);
///     // all.classes[i] is 0, 1, 2 or 3; all.p_sharp[i] its probability of being a sharp edge
///
/// prepare() estimates missing normals, averages points in noise thicker than their spacing
/// (detect/averages.h) and notes it; detect/train.h trains a model. Every error is a
/// pcednet::Error. Work runs on every core unless set_thread_count() bounds it.
///
/// Link pcednet::pcednet. Point files are read and written by formats/read_cloud.h and
/// formats/write_cloud.h, lines are written by io/drawing/drawing.h: find_package(pcednet
/// COMPONENTS formats), pcednet::formats and pcednet::io_drawing.

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/progress.h"
#include "pcednet/core/version.h"
#include "pcednet/detect/averages.h"
#include "pcednet/detect/boundary.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/model.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/detect/result_cloud.h"
#include "pcednet/detect/train.h"
#include "pcednet/lines/find_lines.h"
