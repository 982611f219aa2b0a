// Lines on the graphics card: thick, in front of the points that they lie among, behind all nearer ones.

import {
  Float32BufferAttribute,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  Scene,
  ShaderMaterial,
  Vector2,
  Vector3,
} from "three";
import { rgbOf } from "./colours";

/** A line, and how it is drawn. */
export interface Stroke {
  /** Vertices: x, y, z, x, y, z, ... */
  path: number[];
  fill: string;
  rim: string;
  /** Half widths in CSS pixels: of the line, and of its rim. */
  widths: [number, number];
}

/** How a line is drawn of which there is nothing else to say. */
export const PLAIN: Pick<Stroke, "rim" | "widths"> = { rim: "#ffffff", widths: [1.5, 1] };

interface Box {
  min: [number, number, number];
  max: [number, number, number];
}

const VERTEX = `
attribute vec3 from;
attribute vec3 to;
attribute vec3 fill;
attribute vec3 rim;
attribute vec2 widths;
uniform vec2 size;     // of the canvas
uniform float pixels;  // height of one unit at distance one
uniform float spacing;
uniform float nearest; // that is drawn
uniform float ratio;   // pixels by CSS pixels
uniform bool isRim;
varying vec3 colour;
varying vec3 place;
varying float across;
varying float halfWidth;

/** Towards the eye: the points about a line lie on both sides of it. */
vec4 lifted(vec4 p) {
  float away = length(p.xyz);
  float lift = ((isRim ? 2.5 : 3.0) * (spacing + 2.0 * away / pixels)) / away;
  return projectionMatrix * vec4(p.xyz * (1.0 - min(lift, 0.5)), 1.0);
}

void main() {
  halfWidth = ratio * (isRim ? widths.x + widths.y : widths.x);
  vec4 a = viewMatrix * vec4(from, 1.0);
  vec4 b = viewMatrix * vec4(to, 1.0);
  if ((a.z > -nearest && b.z > -nearest) || (isRim && widths.y == 0.0)) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    return;
  }
  float begin = a.z > -nearest ? (a.z + nearest) / (a.z - b.z) : 0.0;
  float end = b.z > -nearest ? (a.z + nearest) / (a.z - b.z) : 1.0;
  vec4 first = lifted(mix(a, b, begin));
  vec4 last = lifted(mix(a, b, end));
  vec2 along = (last.xy / last.w - first.xy / first.w) * size;
  along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
  float reach = halfWidth + 0.5;
  vec2 shift = (along * (2.0 * position.x - 1.0) + vec2(-along.y, along.x) * position.y) * reach;
  gl_Position = position.x < 0.5 ? first : last;
  gl_Position.xy += 2.0 * shift / size * gl_Position.w;
  across = position.y * reach;
  place = mix(from, to, position.x < 0.5 ? begin : end);
  colour = isRim ? rim : fill;
}`;

const FRAGMENT = `
uniform bool clipped;
uniform vec3 clipMin;
uniform vec3 clipMax;
varying vec3 colour;
varying vec3 place;
varying float across;
varying float halfWidth;
void main() {
  if (clipped && (any(lessThan(place, clipMin)) || any(greaterThan(place, clipMax)))) discard;
  gl_FragColor = vec4(colour, clamp(halfWidth + 0.5 - abs(across), 0.0, 1.0));
}`;

export class LineLayer {
  readonly scene = new Scene();
  private geometry = new InstancedBufferGeometry();
  private readonly uniforms = {
    size: { value: new Vector2(1, 1) },
    pixels: { value: 1 },
    spacing: { value: 0 },
    nearest: { value: 1 },
    ratio: { value: 1 },
    clipped: { value: false },
    clipMin: { value: new Vector3() },
    clipMax: { value: new Vector3() },
  };
  private readonly parts: Mesh[];

  constructor(ratio: number) {
    this.uniforms.ratio.value = ratio;
    this.parts = [true, false].map((isRim, order) => {
      const material = new ShaderMaterial({
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        uniforms: { ...this.uniforms, isRim: { value: isRim } },
        transparent: true,
      });
      const part = new Mesh(this.geometry, material);
      part.frustumCulled = false;
      part.renderOrder = order;
      return part;
    });
  }

  setClip(clip: Box | null): void {
    const u = this.uniforms;
    u.clipped.value = clip !== null;
    if (!clip) return;
    u.clipMin.value.set(...clip.min);
    u.clipMax.value.set(...clip.max);
  }

  setView(width: number, height: number, pixels: number, nearest: number): void {
    this.uniforms.size.value.set(width, height);
    this.uniforms.pixels.value = pixels;
    this.uniforms.nearest.value = nearest;
  }

  /** Shows these lines from now on; `spacing` is that of the points. */
  setLines(lines: Stroke[], spacing: number): void {
    this.uniforms.spacing.value = spacing;
    this.geometry.dispose();
    this.geometry = geometryOf(lines);
    for (const part of this.parts) part.geometry = this.geometry;
    this.scene.children = lines.length > 0 ? this.parts : [];
  }
}

/** A rectangle for every piece of every line. */
function geometryOf(lines: Stroke[]): InstancedBufferGeometry {
  const columns = { from: [], to: [], fill: [], rim: [], widths: [] } as Record<string, number[]>;
  for (const { path, fill, rim, widths } of lines) {
    for (let i = 0; i + 5 < path.length; i += 3) {
      columns.from.push(...path.slice(i, i + 3));
      columns.to.push(...path.slice(i + 3, i + 6));
      columns.fill.push(...rgbOf(fill));
      columns.rim.push(...rgbOf(rim));
      columns.widths.push(...widths);
    }
  }
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0], 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  for (const [name, numbers] of Object.entries(columns)) {
    geometry.setAttribute(name, new InstancedBufferAttribute(new Float32Array(numbers), name === "widths" ? 2 : 3));
  }
  geometry.instanceCount = columns.widths.length / 2;
  return geometry;
}
