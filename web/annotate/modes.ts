// What the colours of the points can show.

import { hasErrors } from "./file_classes";
import type { AppStore, ColourMode } from "./store";

export const MODES: { mode: ColourMode; name: string }[] = [
  { mode: "rgb", name: "original colours" },
  { mode: "normals", name: "normals" },
  { mode: "file", name: "labels of the file" },
  { mode: "las", name: "LAS classes" },
  { mode: "labels", name: "painted labels" },
  { mode: "prediction", name: "prediction" },
  { mode: "errors", name: "errors of prediction" },
  { mode: "confidence", name: "confidence" },
  { mode: "p_sharp", name: "probability of a sharp edge" },
  { mode: "feature", name: "feature" },
];

/** Those that show a prediction. */
export const PREDICTED: ColourMode[] = ["prediction", "errors", "confidence", "p_sharp"];

/** The modes that this cloud has. */
export function modesOf({ now }: Pick<AppStore, "now">): ColourMode[] {
  return MODES.map(({ mode }) => mode).filter(
    (mode) =>
      (mode !== "rgb" || now.session?.has_colours) &&
      (mode !== "file" || (now.session?.file_labels ?? []).length > 0) &&
      (mode !== "errors" || hasErrors(now)) &&
      (mode !== "las" || (now.session?.las_classes ?? []).length > 0) &&
      (mode !== "p_sharp" || now.edges) &&
      (now.hasPrediction || !PREDICTED.includes(mode)),
  );
}
