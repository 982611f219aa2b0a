#include "pcednet/nn/gradient.h"

#include <algorithm>
#include <array>

#include "pcednet/core/parallel.h"
#include "pcednet/core/prefetch.h"
#include "pcednet/nn/plan.h"
#include "pcednet/nn/targets.h"

namespace pcednet::nn {
namespace {

// Long enough that summing a gradient over the lanes costs little beside computing it.
constexpr int kChunk = 128;

}  // namespace

struct GradientMachine::Workspace {
  LaneTable table, deltas;
  std::array<const float*, kChunk> rows;
  LaneTable targets;
  alignas(64) std::array<float, kChunk> weights;
  alignas(64) std::array<float, kChunk> losses;
};

GradientMachine::GradientMachine(const Model& model, InstructionSet instructions)
    : evaluator_(model, instructions) {}

GradientMachine::~GradientMachine() = default;

std::unique_ptr<GradientMachine::Workspace> GradientMachine::borrow() {
  const std::lock_guard lock(mutex_);
  if (idle_.empty()) {
    return std::make_unique<Workspace>(Workspace{evaluator_.make_table(kChunk),
                                                 evaluator_.make_table(kChunk),
                                                 {},
                                                 {evaluator_.classes(), kChunk},
                                                 {},
                                                 {}});
  }
  std::unique_ptr<Workspace> workspace = std::move(idle_.back());
  idle_.pop_back();
  return workspace;
}

void GradientMachine::give_back(std::unique_ptr<Workspace> workspace) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(workspace));
}

double GradientMachine::run(const TrainingSet& set, std::span<const std::uint32_t> chosen,
                            std::span<float> gradient) {
  const std::size_t chunks = (chosen.size() + kChunk - 1) / kChunk;
  chunk_gradients_.assign(chunks * gradient.size(), 0.0f);
  chunk_losses_.assign(chunks, 0.0);
  const float weight = 1.0f / static_cast<float>(chosen.size());
  parallel_blocks(chosen.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    const std::size_t chunk = begin / kChunk;
    std::unique_ptr<Workspace> workspace = borrow();
    chunk_losses_[chunk] = run_chunk(*workspace, set, chosen.subspan(begin, end - begin), weight,
                                     chunk_gradients_.data() + chunk * gradient.size());
    give_back(std::move(workspace));
  });
  std::fill(gradient.begin(), gradient.end(), 0.0f);
  double loss = 0.0;
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
    const float* from = chunk_gradients_.data() + chunk * gradient.size();
    for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] += from[i];
    loss += chunk_losses_[chunk];
  }
  return loss;
}

double GradientMachine::run_chunk(Workspace& w, const TrainingSet& set,
                                  std::span<const std::uint32_t> chosen, float weight,
                                  float* gradient) const {
  const auto inputs = static_cast<std::size_t>(evaluator_.inputs());
  for (std::size_t p = 0; p < kChunk; ++p) {
    const std::size_t sample = chosen[std::min(p, chosen.size() - 1)];
    w.rows[p] = set.samples.data() + sample * inputs;
    // The samples are scattered in memory: prefetch all before the first is needed.
    prefetch_all(std::span(w.rows[p], inputs));
    w.weights[p] = p < chosen.size() ? weight : 0.0f;
  }
  fill_targets(set, chosen, evaluator_.classes(), w.targets);
  evaluator_.run(w.rows.data(), w.table);
  const Kernels& kernels = evaluator_.kernels();
  const Plan& plan = evaluator_.plan();
  const int lanes = w.table.lanes();
  const int logits = evaluator_.logits_row();
  std::fill(w.deltas.row(evaluator_.inputs()), w.deltas.row(logits), 0.0f);
  kernels.cross_entropy(w.table.row(logits), w.targets.row(0), w.weights.data(),
                        evaluator_.classes(), lanes, evaluator_.paired(), w.losses.data(),
                        w.deltas.row(logits));
  const float* parameters = evaluator_.model().network.parameters.data();
  for (auto layer = plan.layers.rbegin(); layer != plan.layers.rend(); ++layer) {
    kernels.activate_backward(
        layer->activation, w.table.row(layer->out_row), w.deltas.row(layer->out_row),
        static_cast<std::size_t>(layer->out_rows) * static_cast<std::size_t>(lanes));
    const bool first = &*layer == &plan.layers.front();
    for (const AffineMap& map : layer->maps) {
      kernels.backward(map, parameters, w.table.row(0), w.deltas.row(0), lanes, !first, gradient);
    }
  }
  double loss = 0.0;
  for (const float l : w.losses) loss += l;
  return loss;
}

}  // namespace pcednet::nn
