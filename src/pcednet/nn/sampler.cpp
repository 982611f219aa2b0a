#include "pcednet/nn/sampler.h"

#include <algorithm>
#include <utility>

namespace pcednet::nn {

Sampler::Sampler(std::vector<std::vector<std::uint32_t>> samples_by_class, bool balanced,
                 Random random)
    : random_(random) {
  if (!balanced) {
    std::vector<std::uint32_t> all;
    for (const auto& samples : samples_by_class) {
      all.insert(all.end(), samples.begin(), samples.end());
    }
    samples_by_class = {std::move(all)};
  }
  for (auto& samples : samples_by_class) {
    if (samples.empty()) continue;
    const std::size_t count = samples.size();
    decks_.push_back({std::move(samples), count});
  }
}

void Sampler::next(std::span<std::uint32_t> batch) {
  for (std::uint32_t& index : batch) {
    Deck& deck = decks_[turn_];
    turn_ = (turn_ + 1) % decks_.size();
    if (deck.next == deck.cards.size()) {
      random_.shuffle(std::span(deck.cards));
      deck.next = 0;
    }
    index = deck.cards[deck.next++];
  }
}

std::size_t Sampler::round() const {
  std::size_t largest = 0;
  for (const Deck& deck : decks_) largest = std::max(largest, deck.cards.size());
  return largest * decks_.size();
}

}  // namespace pcednet::nn
