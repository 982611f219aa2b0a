// What was set up in a cloud, kept while another one is looked at.

import type { Pose } from "./camera";
import type { State } from "./store";

export type CloudView = Pick<
  State,
  "clip" | "measured" | "uncertain" | "predictionVersion" | "lines" | "line" | "showLines"
> & {
  pose: Pose;
};

export function viewOf(now: State, pose: Pose): CloudView {
  const { clip, measured, uncertain, predictionVersion, lines, line, showLines } = now;
  return { pose, clip, measured, uncertain, predictionVersion, lines, line, showLines };
}

/** What of it still holds: a place of another prediction, or a line of another search, is no more. */
export function resumed(
  view: CloudView | undefined,
  now: Pick<State, "predictionVersion" | "lines">,
): Pick<State, "clip" | "measured" | "uncertain" | "line" | "showLines"> {
  if (!view) return { clip: null, measured: [], uncertain: null, line: null, showLines: true };
  const { clip, measured, uncertain, line, showLines } = view;
  const isSameSearch = view.lines.version === now.lines.version;
  return {
    clip,
    measured,
    uncertain: view.predictionVersion === now.predictionVersion ? uncertain : null,
    line: isSameSearch ? line : null,
    showLines: isSameSearch ? showLines : true,
  };
}
