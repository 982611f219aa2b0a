#include <pybind11/stl.h>

#include "bindings.h"
#include "input_cloud.h"
#include "pcednet/normals/neighbour_count.h"
#include "pcednet/normals/prepare.h"

namespace pcednet::python {
namespace {

/// Normals of a cloud: new ones, or the given ones with new signs; facing the scanners where these
/// are known. Also returns the number of points without one.
py::tuple make_normals(const Array<double>& xyz, const OptionalArray<double>& given,
                       const OptionalArray<double>& scanners, int neighbours,
                       const py::object& progress, int threads) {
  normals::PreparedNormals made;
  run_job({progress, threads}, [&](const Progress* job) {
    const InputCloud cloud(xyz, given, {});
    const normals::OrientedNormalsOptions options{.choice = normals::given_neighbours(neighbours)};
    const auto positions = cloud.positions();
    made = given ? normals::complete_and_orient_normals(positions, cloud.normals(), options, job)
                 : normals::estimate_oriented_normals(positions, options, job);
    if (scanners) normals::face_viewpoints(positions, made.normals, vectors(scanners));
  });
  return py::make_tuple(give(std::move(made.normals)), made.unusable);
}

}  // namespace

void add_normals(py::module_& module) {
  module.def("make_normals", make_normals);
}

}  // namespace pcednet::python
