#pragma once

#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/vec3.h"

namespace pcednet::io {

/// Appends the position of the next scan's scanner, NaN if unknown, and a comment of the form
/// "scanner INDEX: X Y Z" if known, so that it survives in other formats.
void add_scanner(const Vec3& position, PointCloud& cloud);

/// The positions in such comments. Unnamed ones are NaN.
std::vector<Vec3> scanners_of_comments(const std::vector<std::string>& comments);

/// Whether the scanners stood at the same places; two unknown places count as the same.
bool are_same(const std::vector<Vec3>& a, const std::vector<Vec3>& b);

/// Gives the cloud these scanners, and their comments in place of others.
void set_scanners(const std::vector<Vec3>& scanners, PointCloud& cloud);

/// Whether the points are of several scans, so that no scanner saw all.
bool has_several_scans(const PointCloud& cloud);

}  // namespace pcednet::io
