#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/random.h"

namespace pcednet::nn {

/// An endless stream of sample indices in random order.
///
/// Balanced: the classes take turns, and each runs through its samples again and again, which is
/// the same as replicating the samples of the small ones. Otherwise all samples come once before
/// any comes again.
class Sampler {
 public:
  /// `samples_by_class` must hold at least one sample; empty classes are passed over.
  Sampler(std::vector<std::vector<std::uint32_t>> samples_by_class, bool balanced, Random random);

  void next(std::span<std::uint32_t> batch);

  /// The samples of one round in which the largest class is seen once.
  std::size_t round() const;

 private:
  struct Deck {
    std::vector<std::uint32_t> cards;
    std::size_t next = 0;
  };

  std::vector<Deck> decks_;
  std::size_t turn_ = 0;
  Random random_;
};

}  // namespace pcednet::nn
