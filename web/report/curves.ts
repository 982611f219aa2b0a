// Learning curves: what falls and what rises, epoch by epoch.

import { seriesColour } from "../shared/colours";
import { h } from "../shared/dom";
import { linePlot, type Line } from "../shared/lines";
import { spreadOf, titleOf, type Epoch, type Study } from "./study";

type Quantity = "loss" | "held_out_loss" | "held_out_mcc";

/** For each variant the mean over its seeds at each epoch, and the spread. */
function linesOf(study: Study, quantities: Quantity[], epochs: number[]): Line[] {
  const curves = study.curves ?? [];
  return study.variants.flatMap((variant, index) => {
    const own = curves.filter((curve) => curve.variant === variant.id);
    return quantities.flatMap((quantity): Line[] => {
      const spreads = epochs.map((epoch) =>
        spreadOf(own.map((curve) => curve.epochs.find((e: Epoch) => e.epoch === epoch)?.[quantity])),
      );
      if (spreads.every((spread) => spread === null)) return [];
      const held = quantity === "held_out_loss";
      return [
        {
          name: titleOf(variant) + (held ? ", held out" : ""),
          colour: seriesColour(index),
          dashed: held,
          y: spreads.map((s) => s?.mean ?? null),
          error: spreads.map((s) => s?.deviation ?? null),
        },
      ];
    });
  });
}

/** The plots of a study's curves; none if it has none. */
export function learningCurves(study: Study): HTMLElement[] {
  const epochs = [...new Set((study.curves ?? []).flatMap((c) => c.epochs.map((e) => e.epoch)))].sort((a, b) => a - b);
  const plots: [string, Quantity[]][] = [
    ["loss", ["loss", "held_out_loss"]],
    ["MCC on held-out points", ["held_out_mcc"]],
  ];
  return plots.flatMap(([yLabel, quantities]) => {
    const lines = linesOf(study, quantities, epochs);
    if (lines.length === 0) return [];
    return [
      h(
        "figure",
        { class: "wide" },
        linePlot({ x: epochs, lines, xLabel: "epoch", yLabel, scores: yLabel.startsWith("MCC") }),
      ),
    ];
  });
}
