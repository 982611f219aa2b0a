// The curves of a training, epoch by epoch.

import type { Training } from "./store";
import type { TrainingEvent } from "./types";

/** Those of `old` with one epoch more; new ones if another training has begun. */
export function withEpoch(old: Training | null, event: TrainingEvent): Training {
  const same = old !== null && old.active && old.run === event.run && event.epoch > (old.epoch.at(-1) ?? 0);
  const before = same ? old : { epoch: [], loss: [], context: [] };
  return {
    run: event.run,
    active: true,
    epochs: event.epochs,
    epoch: [...before.epoch, event.epoch],
    loss: [...before.loss, event.context ? null : event.loss],
    context: [...before.context, event.context ? event.loss : null],
  };
}
