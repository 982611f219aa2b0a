#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/random.h"

namespace pcednet::nn {

/// An endless stream of sample indices in random order.
///
/// `balance` 1: the classes take turns, each cycling through its samples, which equals replicating
/// the samples of small classes. 0: all samples come once before any repeats. Between: the classes,
/// each cycling through its samples, have shares proportional to their number of samples to the
/// power of 1 - balance.
class Sampler {
 public:
  /// `samples_by_class` must hold at least one sample; empty classes are skipped.
  Sampler(std::vector<std::vector<std::uint32_t>> samples_by_class, double balance, Random random);

  void next(std::span<std::uint32_t> batch);

  /// The samples of one round in which the largest class is seen once.
  std::size_t round() const;

 private:
  struct Deck {
    std::vector<std::uint32_t> cards;
    std::size_t next = 0;
    double share = 1.0;  ///< of the samples drawn
    double credit = 0.0;
  };

  Deck& deck_in_turn();

  std::vector<Deck> decks_;
  Random random_;
};

}  // namespace pcednet::nn
