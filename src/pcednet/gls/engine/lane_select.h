#pragma once

#include "pcednet/core/simd.h"
#include "pcednet/gls/engine/lane_types.h"

/// Which candidates come near enough to matter, a candidate per lane.
namespace pcednet::gls {
namespace {  // each unit has its own copy, see simd.h

/// Appends the candidates of `in` at [first, first + W) whose bit in `hits` is set.
template <int W>
inline void append(const Candidates& in, std::size_t first, unsigned hits, Candidates& out) {
#if defined(__AVX512F__)
  if constexpr (W == 16) {
    const auto mask = static_cast<__mmask16>(hits);
    const auto move = [&](const float* from, float* to) {
      _mm512_storeu_ps(to + out.count,
                       _mm512_maskz_compress_ps(mask, _mm512_loadu_ps(from + first)));
    };
    if (out.x) move(in.x, out.x), move(in.y, out.y), move(in.z, out.z);
    _mm512_storeu_si512(out.index + out.count,
                        _mm512_maskz_compress_epi32(mask, _mm512_loadu_si512(in.index + first)));
    out.count += static_cast<std::size_t>(__builtin_popcount(hits));
    return;
  }
#endif
  std::size_t kept = out.count;
  for (; hits != 0; hits &= hits - 1, ++kept) {
    const std::size_t i = first + static_cast<std::size_t>(__builtin_ctz(hits));
    if (out.x) out.x[kept] = in.x[i], out.y[kept] = in.y[i], out.z[kept] = in.z[i];
    out.index[kept] = in.index[i];
  }
  out.count = kept;
}

/// An interval along an axis, as its middle and half its length.
template <int W>
struct Interval {
  Floats<W> middle, half;

  Interval(float min, float max)
      : middle(splat<W>(0.5f * (min + max))), half(splat<W>(0.5f * (max - min))) {}

  Floats<W> distance(Floats<W> v) const { return absolute(v - middle); }
  Floats<W> to_near_end(Floats<W> distance) const { return positive_part(distance - half); }
};

template <int W, bool kSplit>
void choose(const Candidates& from, const SourceBox& box, float reach, float inner, Candidates& to,
            Candidates& to_inside) {
  using Lanes = Floats<W>;
  const Candidates in = from;  // copies, which the stores below cannot change
  Candidates out = to, inside = to_inside;
  out.count = inside.count = 0;
  const Interval<W> x(box.min[0], box.max[0]), y(box.min[1], box.max[1]), z(box.min[2], box.max[2]);
  const Lanes sq_reach = splat<W>(reach * reach), sq_inner = splat<W>(inner * inner);
  for (std::size_t first = 0; first < in.count; first += W) {
    const Lanes dx = x.distance(load<W>(in.x + first)), dy = y.distance(load<W>(in.y + first)),
                dz = z.distance(load<W>(in.z + first));
    const Lanes nx = x.to_near_end(dx), ny = y.to_near_end(dy), nz = z.to_near_end(dz);
    unsigned hits = bits_below(nx * nx + (ny * ny + nz * nz), sq_reach);
    if (hits == 0) continue;  // they come in stretches
    const std::size_t left = in.count - first;
    if (left < W) hits &= (1u << left) - 1;
    if constexpr (kSplit) {
      const Lanes fx = dx + x.half, fy = dy + y.half, fz = dz + z.half;
      const unsigned within = hits & bits_below(fx * fx + (fy * fy + fz * fz), sq_inner);
      append<W>(in, first, within, inside);
      hits &= ~within;
    }
    append<W>(in, first, hits, out);
  }
  to.count = out.count;
  if constexpr (kSplit) to_inside.count = inside.count;
}

template <int W>
void select(const Candidates& in, const SourceBox& box, float reach, Candidates& out) {
  choose<W, false>(in, box, reach, 0.0f, out, out);
}

template <int W>
void split(const Candidates& in, const SourceBox& box, float reach, float inner, Candidates& out,
           Candidates& inside) {
  choose<W, true>(in, box, reach, inner, out, inside);
}

inline std::size_t part_open(const Source* sources, const std::uint32_t* indices, std::size_t count,
                             const NormalBox& normals, float least, std::uint32_t* open,
                             std::uint32_t* rest) {
  constexpr std::size_t kAtOnce = 64;
  const float *m = normals.middle, *h = normals.half;
  std::size_t opens = 0, rests = 0;
  for (std::size_t begin = 0; begin < count; begin += kAtOnce) {
    const std::size_t here = count - begin < kAtOnce ? count - begin : kAtOnce;
    float cosine[kAtOnce];
    for (std::size_t j = 0; j < here; ++j) {
      const Source& s = sources[indices[begin + j]];
      const float x = s.nx < 0.0f ? -s.nx : s.nx, y = s.ny < 0.0f ? -s.ny : s.ny,
                  z = s.nz < 0.0f ? -s.nz : s.nz;
      cosine[j] = m[0] * s.nx + (m[1] * s.ny + m[2] * s.nz) - (h[0] * x + (h[1] * y + h[2] * z));
    }
    for (std::size_t j = 0; j < here; ++j) {
      const std::uint32_t index = indices[begin + j];
      open[opens] = rest[rests] = index;
      const bool is_open = cosine[j] >= least;
      opens += is_open ? 1 : 0, rests += is_open ? 0 : 1;
    }
  }
  return opens;
}

}  // namespace
}  // namespace pcednet::gls
