// The density of points in the unit square, as filled shapes.

export interface Grid {
  side: number;
  values: Float64Array;
}

/** A sum of normal distributions of width `sigma` at (x, y) on a grid from -margin to 1 + margin. */
export function densityOf(points: [number, number][], sigma: number, side: number, margin: number): Grid {
  const values = new Float64Array(side * side);
  for (let j = 0; j < side; ++j) {
    for (let i = 0; i < side; ++i) {
      const x = -margin + ((1 + 2 * margin) * i) / (side - 1);
      const y = -margin + ((1 + 2 * margin) * j) / (side - 1);
      for (const [a, b] of points) {
        values[j * side + i] += Math.exp(-((x - a) ** 2 + (y - b) ** 2) / (2 * sigma * sigma));
      }
    }
  }
  return { side, values };
}

/** An SVG path, in cells of the grid, that fills where the density is at least `level`. */
export function filledAbove(grid: Grid, level: number): string {
  const at = (i: number, j: number): number => grid.values[j * grid.side + i];
  let path = "";
  for (let j = 0; j + 1 < grid.side; ++j) {
    for (let i = 0; i + 1 < grid.side; ++i) {
      const corners = [
        [i, j],
        [i + 1, j],
        [i + 1, j + 1],
        [i, j + 1],
      ];
      if (corners.every(([x, y]) => at(x, y) < level)) continue;
      const outline: string[] = [];
      corners.forEach(([x, y], k) => {
        const [u, v] = corners[(k + 1) % 4];
        const [here, there] = [at(x, y), at(u, v)];
        if (here >= level) outline.push(`${x} ${y}`);
        if (here >= level !== there >= level) {
          const t = (level - here) / (there - here);
          outline.push(`${(x + t * (u - x)).toFixed(2)} ${(y + t * (v - y)).toFixed(2)}`);
        }
      });
      path += `M${outline.join("L")}Z`;
    }
  }
  return path;
}
