#include "pcednet/nn/sampler.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcednet::nn {

Sampler::Sampler(std::vector<std::vector<std::uint32_t>> samples_by_class, double balance,
                 Random random)
    : random_(random) {
  if (balance == 0.0) {
    std::vector<std::uint32_t> all;
    for (const auto& samples : samples_by_class) {
      all.insert(all.end(), samples.begin(), samples.end());
    }
    samples_by_class = {std::move(all)};
  }
  double sum = 0.0;
  for (auto& samples : samples_by_class) {
    if (samples.empty()) continue;
    const std::size_t count = samples.size();
    decks_.push_back({std::move(samples), count});
    decks_.back().share = std::pow(static_cast<double>(count), 1.0 - balance);
    sum += decks_.back().share;
  }
  for (Deck& deck : decks_) deck.share /= sum;
}

Sampler::Deck& Sampler::deck_in_turn() {
  Deck* best = &decks_[0];
  for (Deck& deck : decks_) {
    deck.credit += deck.share;
    if (deck.credit > best->credit + 1e-9) best = &deck;
  }
  best->credit -= 1.0;
  return *best;
}

void Sampler::next(std::span<std::uint32_t> batch) {
  for (std::uint32_t& index : batch) {
    Deck& deck = deck_in_turn();
    if (deck.next == deck.cards.size()) {
      random_.shuffle(std::span(deck.cards));
      deck.next = 0;
    }
    index = deck.cards[deck.next++];
  }
}

std::size_t Sampler::round() const {
  double round = 0.0;
  for (const Deck& deck : decks_) {
    round = std::max(round, static_cast<double>(deck.cards.size()) / deck.share);
  }
  return static_cast<std::size_t>(std::lround(round));
}

}  // namespace pcednet::nn
