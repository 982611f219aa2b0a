#include "pcednet/gls/features.h"

#include <array>

#include "pcednet/core/vec3.h"
#include "pcednet/gls/descriptor.h"

namespace pcednet::gls {
namespace {

constexpr std::array<std::string_view, 28> kAllNames = {
    "tau",       "kappa",     "k1",        "dtau",      "dkappa",    "phi",       "k2",
    "eta_x",     "eta_y",     "eta_z",     "deta_x",    "deta_y",    "deta_z",    "dtau_dx",
    "dtau_dy",   "dtau_dz",   "dkappa_dx", "dkappa_dy", "dkappa_dz", "deta_x_dx", "deta_x_dy",
    "deta_x_dz", "deta_y_dx", "deta_y_dy", "deta_y_dz", "deta_z_dx", "deta_z_dy", "deta_z_dz"};
constexpr std::array<std::string_view, 4> kSpatialNames = {"tau", "kappa", "k1", "phi"};
constexpr std::array<std::string_view, 3> kReliefNames = {"tau", "dtau", "phi"};

}  // namespace

std::span<const FeatureSet> feature_sets() {
  static constexpr std::array kSets = {FeatureSet::kAll28, FeatureSet::kInvariant7,
                                       FeatureSet::kPaper6, FeatureSet::kSpatial4,
                                       FeatureSet::kRelief3};
  return kSets;
}

std::span<const std::string_view> feature_names(FeatureSet set) {
  const std::span<const std::string_view> all = kAllNames;
  switch (set) {
    case FeatureSet::kAll28:
      return all;
    case FeatureSet::kInvariant7:
      return all.first(7);
    case FeatureSet::kPaper6:
      return all.first(6);
    case FeatureSet::kSpatial4:
      return kSpatialNames;
    case FeatureSet::kRelief3:
      break;
  }
  return kReliefNames;
}

int feature_count(FeatureSet set) {
  return static_cast<int>(feature_names(set).size());
}

void write_features(FeatureSet set, const Descriptor& d, double t, std::span<double> out) {
  auto next = out.begin();
  const auto put = [&](double value) { *next++ = value; };
  const auto put_vector = [&](const Vec3& v) {
    for (int i = 0; i < 3; ++i) put(v[i]);
  };
  const double tau = d.tau / t, kappa = d.kappa * t, k1 = d.k1 * t;
  const double dkappa = d.dkappa_dt * t * t;
  if (set == FeatureSet::kRelief3) {
    put(tau), put(d.dtau_dt), put(d.phi);
    return;
  }
  put(tau), put(kappa), put(k1);
  if (set != FeatureSet::kSpatial4) put(d.dtau_dt), put(dkappa);
  put(d.phi);
  if (set != FeatureSet::kInvariant7 && set != FeatureSet::kAll28) return;
  put(d.k2 * t);
  if (set != FeatureSet::kAll28) return;
  put_vector(d.eta);
  put_vector(d.deta_dt * t);
  put_vector(d.dtau_dx);
  put_vector(d.dkappa_dx * (t * t));
  for (int i = 0; i < 3; ++i) put_vector(d.deta_dx.row(i).transpose() * t);
}

}  // namespace pcednet::gls
