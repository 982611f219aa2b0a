#include "pcednet/detect/points/points_used.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/detect/points/far_points.h"
#include "pcednet/detect/points/rounding.h"
#include "pcednet/detect/points/scanner_poles.h"
#include "pcednet/detect/points/thinned_cloud.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {
namespace {

/// Takes the position from points that are far from all others.
void leave_out_far_points(PreparedCloud& prepared) {
  const std::vector<std::uint32_t> far = far_points(prepared.positions);
  if (far.empty()) return;
  prepared.notes.push_back(note_on_far(far, prepared.positions));
  prepared.moved.assign(prepared.positions.begin(), prepared.positions.end());
  for (const std::uint32_t i : far) {
    prepared.moved[i] = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  prepared.positions = prepared.moved;
}

/// Puts these in place of the positions.
void use_positions(std::vector<Vec3> positions, PreparedCloud& prepared) {
  prepared.moved = std::move(positions);
  prepared.positions = prepared.moved;
  prepared.curve = spatial::curve_order(prepared.positions);
}

/// The parts of the cloud that are used then.
Points use_averages(ThinnedCloud&& thinned, PreparedCloud& prepared) {
  prepared.decision.averaging = thinned.averaging;
  prepared.average_of = std::move(thinned.average_of);
  use_positions(std::move(thinned.positions), prepared);
  return {prepared.positions, {}, [] { return std::vector<Vec3>(); }};
}

/// The points that are kept. `decided`: also if few are not, and without a note.
Points leave_out_poles(const Points& cloud, bool decided, PreparedCloud& prepared,
                       const Progress* progress) {
  const std::vector<Vec3> scanners = cloud.scanners();
  if (scanners.empty()) return cloud;
  WithoutPoles thinned = without_poles(prepared.positions, scanners, prepared.curve, progress);
  if (!decided && !thinned.are_many()) return cloud;
  if (!decided) prepared.notes.push_back(note_on(thinned));
  prepared.decision.poles = true;
  prepared.scanners = spatial::in_order(scanners, thinned.kept);
  prepared.average_of = std::move(thinned.average_of);
  use_positions(spatial::in_order(prepared.positions, thinned.kept), prepared);
  return {prepared.positions, {}, [&prepared] { return prepared.scanners; }};
}

}  // namespace

void order_finite_points(PreparedCloud& prepared) {
  leave_out_far_points(prepared);
  prepared.curve = spatial::curve_order(prepared.positions);
  const std::size_t points = prepared.positions.size(), finite = prepared.curve.size();
  if (finite == 0) throw Error(ErrorKind::kInsufficient, "no point has a finite position");
  if (finite == points) return;
  prepared.notes.push_back(fmt::format("{} of {} points have no finite position: kept, unlabelled",
                                       points - finite, points));
}

Points fewer_points(const Points& cloud, PreparedCloud& prepared, const Progress* progress) {
  if (auto thinned = thin_noise(prepared.positions, prepared.curve, progress)) {
    prepared.notes.push_back(note_on(*thinned));
    return use_averages(std::move(*thinned), prepared);
  }
  return leave_out_poles(cloud, false, prepared, progress);
}

void spread_positions(const Rounding& rounding, PreparedCloud& prepared) {
  if (rounding.step == 0.0) return;
  use_positions(spread(prepared.positions, rounding), prepared);
  prepared.notes.push_back(note_on(rounding));
}

Points points_as_decided(const Points& cloud, PreparedCloud& prepared, const Progress* progress) {
  const NormalsDecision& decision = prepared.decision;
  Points used = cloud;
  if (decision.averaging.deviation > 0.0) {
    used = use_averages(
        thin_as_decided(prepared.positions, prepared.curve, decision.averaging, progress),
        prepared);
  } else if (decision.poles) {
    used = leave_out_poles(cloud, true, prepared, progress);
  }
  spread_positions(decision.rounding, prepared);
  return used;
}

}  // namespace pcednet::detect
