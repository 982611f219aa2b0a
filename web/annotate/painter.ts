// Chunks on the graphics card.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  NearestFilter,
  Points,
  Scene,
  ShaderMaterial,
  Vector3,
  WebGLRenderer,
  type PerspectiveCamera,
} from "three";
import { rgbOf } from "../shared/colours";
import { LineLayer } from "../shared/line_layer";
import type { Chunk } from "./chunk";
import { MOST_CLASSES, NONE } from "./classes";
import { EyeDome } from "./eye_dome";
import { FRAGMENT, VERTEX } from "./shaders";
import type { Box } from "./types";

export type Layer = "labels" | "prediction" | "values";

/** What the shader needs to know besides the points. */
export interface Appearance {
  mode: "labels" | "rgb" | "normals" | "prediction" | "ramp";
  /** What the ramp colours; a chunk whose values are something else has no colour yet. */
  values: string | null;
  paintOnTop: boolean;
  /** By class, and NONE. */
  palette: string[];
  ramp: Uint8Array;
  hidden: ReadonlySet<number>;
  clip: Box | null;
  pointSize: number;
  background: string;
  /** With eye-dome lighting. */
  eyeDome: boolean;
}

const MODES = ["labels", "rgb", "normals", "prediction", "ramp", "none"];
const ATTRIBUTE: Record<Layer, string> = { labels: "label", prediction: "said", values: "value" };

/** Is WebGL drawn by the processor here? */
function isSoftware(renderer: WebGLRenderer): boolean {
  const gl = renderer.getContext();
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

export class Painter {
  readonly renderer: WebGLRenderer;
  readonly ratio: number;
  /** WebGL is drawn by the processor. */
  readonly isSoftware: boolean;
  private eyeDome: EyeDome | null = null;
  private background: [number, number, number] = [0, 0, 0];
  readonly lines: LineLayer;
  private readonly scene = new Scene();
  private readonly onCard = new Map<number, Points>();
  private readonly material: ShaderMaterial;
  private readonly ramp = new DataTexture(new Uint8Array(1024), 256, 1);
  private spacings = new Map<number, Float32Array>();
  private look!: Appearance;
  private fresh = false;
  private size: [number, number] = [1, 1];

  /** Throws if the browser offers no WebGL. */
  constructor(private readonly canvas: HTMLCanvasElement) {
    // What was drawn stays, so that a view at rest is filled in over several frames.
    this.renderer = new WebGLRenderer({ canvas, antialias: false, preserveDrawingBuffer: true });
    this.renderer.autoClear = false;
    this.isSoftware = isSoftware(this.renderer);
    this.ratio = this.isSoftware ? 1 : Math.min(window.devicePixelRatio, 2);
    this.renderer.setPixelRatio(this.ratio);
    this.lines = new LineLayer(this.ratio);
    this.ramp.minFilter = this.ramp.magFilter = NearestFilter;
    this.scene.matrixWorldAutoUpdate = false;
    this.material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        mode: { value: 0 },
        paint: { value: true },
        palette: { value: Array.from({ length: NONE + 1 }, () => new Vector3()) },
        ramp: { value: this.ramp },
        hidden: { value: new Float32Array(MOST_CLASSES) },
        clipped: { value: false },
        clipMin: { value: new Vector3() },
        clipMax: { value: new Vector3() },
        pixels: { value: 1 },
        spacings: { value: new Float32Array(8) },
        size: { value: 1 },
        least: { value: 1.5 },
      },
    });
  }

  resize(width: number, height: number): void {
    this.renderer.setSize(width, height, false);
    this.size = [width * this.ratio, height * this.ratio];
    this.eyeDome?.resize(...this.size);
  }

  setAppearance(look: Appearance): void {
    const u = this.material.uniforms;
    this.look = look;
    u.paint.value = look.paintOnTop;
    look.palette.forEach((colour, i) => u.palette.value[i].set(...rgbOf(colour)));
    (this.ramp.image.data as Uint8Array).set(look.ramp);
    this.ramp.needsUpdate = true;
    u.hidden.value = Float32Array.from({ length: MOST_CLASSES }, (_, c) => Number(look.hidden.has(c)));
    u.clipped.value = look.clip !== null;
    if (look.clip) {
      u.clipMin.value.set(...look.clip.min);
      u.clipMax.value.set(...look.clip.max);
    }
    u.size.value = look.pointSize;
    u.least.value = 1.5 * this.ratio;
    this.lines.setClip(look.clip);
    this.background = rgbOf(look.background);
    this.renderer.setClearColor(new Color(look.background));
    if (look.eyeDome && !this.eyeDome) {
      this.eyeDome = new EyeDome(this.renderer, this.ratio);
      this.eyeDome.resize(...this.size);
    } else if (!look.eyeDome) {
      this.eyeDome?.dispose();
      this.eyeDome = null;
    }
  }

  setSpacings(spacings: Map<number, Float32Array>): void {
    this.spacings = spacings;
  }

  clear(): void {
    this.eyeDome?.begin();
    this.renderer.clear();
    this.renderer.setRenderTarget(null);
  }

  /** Draws the first points of each chunk over what there is; the milliseconds it took, or none for a first time. */
  draw(
    takes: { chunk: Chunk; points: number }[],
    camera: PerspectiveCamera,
    pixels: number,
    stretch: number,
  ): number | null {
    this.fresh = false;
    this.material.uniforms.pixels.value = pixels * this.ratio;
    this.scene.children = takes.map(({ chunk, points }) => {
      const object = this.objectOf(chunk);
      object.geometry.setDrawRange(0, points);
      return object;
    });
    const start = performance.now();
    this.eyeDome?.begin();
    this.renderer.render(this.scene, camera);
    this.eyeDome?.show(camera, stretch, this.background);
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits until it is drawn
    return this.fresh ? null : performance.now() - start;
  }

  /** Draws the lines over what there is. */
  drawLines(camera: PerspectiveCamera, pixels: number): void {
    if (this.lines.scene.children.length === 0) return;
    this.lines.setView(...this.size, pixels * this.ratio, camera.near);
    this.renderer.render(this.lines.scene, camera);
  }

  private objectOf(chunk: Chunk): Points {
    const known = this.onCard.get(chunk.info.id);
    if (known) return known;
    this.fresh = true;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(chunk.positions, 3, true));
    geometry.setAttribute("oct", new BufferAttribute(chunk.normals, 2, true));
    if (chunk.colours) geometry.setAttribute("rgb", new BufferAttribute(chunk.colours, 3, true));
    geometry.setAttribute("label", new BufferAttribute(chunk.labels, 1));
    geometry.setAttribute("said", new BufferAttribute(chunk.prediction, 1));
    geometry.setAttribute("value", new BufferAttribute(chunk.values, 1, true));
    const object = new Points(geometry, this.material);
    const { centre, half } = chunk.info;
    object.frustumCulled = false;
    object.position.set(centre[0] - half, centre[1] - half, centre[2] - half);
    object.scale.setScalar(2 * half);
    object.updateMatrixWorld(true);
    object.onBeforeRender = () => {
      const { mode, values } = this.look;
      const isMissing = mode === "ramp" && chunk.valuesOf !== values;
      this.material.uniforms.mode.value = MODES.indexOf(isMissing ? "none" : mode);
      this.material.uniforms.spacings.value =
        this.spacings.get(chunk.info.id) ?? new Float32Array(8).fill(chunk.info.spacing);
      this.material.uniformsNeedUpdate = true;
    };
    this.onCard.set(chunk.info.id, object);
    return object;
  }

  /** A layer of a chunk has changed. */
  refresh(id: number, layer: Layer): void {
    const attribute = this.onCard.get(id)?.geometry.getAttribute(ATTRIBUTE[layer]);
    if (attribute) attribute.needsUpdate = true;
  }

  forget(id: number): void {
    this.onCard.get(id)?.geometry.dispose();
    this.onCard.delete(id);
  }

  /** The picture as it is now. */
  picture(): Promise<Blob | null> {
    return new Promise((done) => this.canvas.toBlob(done, "image/png"));
  }
}
