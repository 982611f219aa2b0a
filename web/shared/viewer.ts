// Several colourings of one cloud side by side, seen by one camera.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  PerspectiveCamera,
  Points,
  Scene,
  ShaderMaterial,
  Spherical,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { rgbOf, type Meaning } from "./colours";
import { LineLayer, type Stroke } from "./line_layer";
import { UNFOLD } from "./unfold";

const MAX_CODES = 8;
const FIELD_OF_VIEW = 30;

const VERTEX = `
attribute vec2 oct;
attribute float code;
uniform vec3 palette[${MAX_CODES}];
uniform float pixels;   // height of one unit at distance one
uniform float size;     // of a point, in units
varying vec3 colour;

${UNFOLD}
void main() {
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  vec3 n = normalMatrix * unfold(oct * 2.0 - 1.0);
  // A lamp a little above the eye; normals of either sign.
  float light = abs(dot(normalize(n), normalize(vec3(0.25, 0.45, 1.0))));
  bool plain = code < 0.5;
  colour = palette[int(code + 0.5)] * mix(plain ? 0.42 : 0.72, 1.0, light);
  // Marks lie on top of the points around them.
  float lift = plain ? 0.0 : min(size / length(seen.xyz), 0.5);
  gl_Position = projectionMatrix * vec4(seen.xyz * (1.0 - lift), 1.0);
  gl_PointSize = clamp(size * pixels / -seen.z, 1.5, 64.0);
}`;

const FRAGMENT = `
varying vec3 colour;
void main() {
  vec2 p = gl_PointCoord - 0.5;
  if (dot(p, p) > 0.25) discard;
  gl_FragColor = vec4(colour, 1.0);
}`;

export interface Cloud {
  /** Three a point; 65535 is the longest side of the box. */
  positions: Uint16Array;
  /** Two a point: octahedral normals. */
  normals: Uint8Array;
  /** A direction to look along at first. */
  view: number[];
}

/** Where a panel lies in the canvas, in CSS pixels from its upper left corner. */
export interface Place {
  x: number;
  y: number;
  width: number;
  height: number;
}

export class PointViewer {
  private readonly renderer: WebGLRenderer;
  private readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 20);
  private readonly controls: OrbitControls;
  private readonly material: ShaderMaterial;
  private readonly scene = new Scene();
  private readonly points: Points;
  private geometries: BufferGeometry[] = [];
  private readonly layers: LineLayer[] = [];
  private places: Place[] = [];
  private home = new Vector3(0, 0, 1);
  private centre = new Vector3(0.5, 0.5, 0.5);
  private spacing = 0.01;
  private waiting = false;

  /** Throws if the browser offers no WebGL. */
  constructor(private readonly canvas: HTMLCanvasElement) {
    // The picture is kept: printing shows what is there, between two drawings.
    this.renderer = new WebGLRenderer({
      canvas,
      antialias: true,
      powerPreference: "low-power",
      preserveDrawingBuffer: true,
    });
    this.renderer.autoClear = false;
    this.renderer.setScissorTest(true);
    this.material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        palette: { value: Array.from({ length: MAX_CODES }, () => new Vector3()) },
        pixels: { value: 1 },
        size: { value: 0.01 },
      },
    });
    this.points = new Points(new BufferGeometry(), this.material);
    this.points.frustumCulled = false;
    this.scene.add(this.points);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    // The wheel scrolls the page until the canvas has been clicked.
    this.controls.enableZoom = false;
    canvas.addEventListener("pointerdown", () => canvas.focus({ preventScroll: true }));
    canvas.addEventListener("focus", () => (this.controls.enableZoom = true));
    canvas.addEventListener("blur", () => (this.controls.enableZoom = false));
    canvas.addEventListener("keydown", (event) => this.onKey(event));
  }

  setCloud(cloud: Cloud): void {
    const count = cloud.positions.length / 3;
    const largest = [0, 0, 0];
    for (let i = 0; i < cloud.positions.length; ++i) {
      largest[i % 3] = Math.max(largest[i % 3], cloud.positions[i] / 65535);
    }
    const extent = new Vector3(...largest);
    this.centre = extent.clone().multiplyScalar(0.5);
    // Points that tile the faces of the box: near enough for surfaces.
    const area = 2 * (extent.x * extent.y + extent.y * extent.z + extent.z * extent.x);
    this.spacing = Math.sqrt(Math.max(area, 1e-3) / count);
    const distance = (0.5 * Math.max(extent.length(), 0.1)) / Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    this.home = new Vector3(...cloud.view).normalize().multiplyScalar(-distance).add(this.centre);
    this.shared = {
      position: new BufferAttribute(cloud.positions, 3, true),
      oct: new BufferAttribute(cloud.normals, 2, true),
    };
    this.setPanels([]);
    this.reset();
  }
  private shared: Record<string, BufferAttribute> = {};

  /** One panel for each array of codes, a byte a point. */
  setPanels(codes: Uint8Array[]): void {
    for (const geometry of this.geometries) geometry.dispose();
    this.geometries = codes.map((code) => {
      const geometry = new BufferGeometry();
      for (const [name, attribute] of Object.entries(this.shared)) geometry.setAttribute(name, attribute);
      geometry.setAttribute("code", new BufferAttribute(code, 1));
      return geometry;
    });
    this.draw();
  }

  /** The lines of each panel; 1 is the longest side of the box of the points. */
  setLines(lines: Stroke[][]): void {
    while (this.layers.length < lines.length) this.layers.push(new LineLayer(this.renderer.getPixelRatio()));
    this.layers.forEach((layer, i) => layer.setLines(lines[i] ?? [], this.spacing));
    this.draw();
  }

  /** The colour of each code. */
  setPalette(meanings: Meaning[]): void {
    meanings.forEach(({ colour }, i) => this.material.uniforms.palette.value[i].set(...rgbOf(colour)));
    this.draw();
  }

  setPointSize(factor: number): void {
    this.material.uniforms.size.value = this.spacing * factor;
    this.draw();
  }

  setBackground(colour: string): void {
    this.renderer.setClearColor(new Color(colour));
    this.draw();
  }

  /** The size of the canvas and the panels in it, all of one size. */
  setLayout(width: number, height: number, places: Place[]): void {
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.places = places;
    if (places.length > 0) {
      this.camera.aspect = places[0].width / places[0].height;
      this.camera.updateProjectionMatrix();
      // Turning across one panel turns as far as turning across a canvas of one.
      this.controls.rotateSpeed = height / places[0].height;
    }
    this.draw();
  }

  reset(): void {
    this.camera.position.copy(this.home);
    this.controls.target.copy(this.centre);
    this.controls.update();
    this.draw();
  }

  /** Draws before the next frame, once however often it is called. */
  draw(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.drawNow();
    });
  }

  private drawNow(): void {
    const height = this.canvas.clientHeight;
    this.renderer.setScissor(0, 0, this.canvas.clientWidth, height);
    this.renderer.setViewport(0, 0, this.canvas.clientWidth, height);
    this.renderer.clear();
    this.geometries.forEach((geometry, i) => {
      const place = this.places[i];
      if (!place) return;
      const bottom = height - place.y - place.height;
      this.renderer.setViewport(place.x, bottom, place.width, place.height);
      this.renderer.setScissor(place.x, bottom, place.width, place.height);
      const ratio = this.renderer.getPixelRatio();
      const pixels = (place.height * ratio) / (2 * Math.tan((FIELD_OF_VIEW * Math.PI) / 360));
      this.material.uniforms.pixels.value = pixels;
      this.points.geometry = geometry;
      this.renderer.render(this.scene, this.camera);
      const lines = this.layers[i];
      if (!lines) return;
      lines.setView(place.width * ratio, place.height * ratio, pixels, this.camera.near);
      this.renderer.render(lines.scene, this.camera);
    });
  }

  private onKey(event: KeyboardEvent): void {
    const arm = this.camera.position.clone().sub(this.controls.target);
    const turn = new Spherical().setFromVector3(new Vector3(arm.y, arm.z, arm.x)); // z is up
    switch (event.key) {
      case "ArrowLeft":
        turn.theta -= 0.1;
        break;
      case "ArrowRight":
        turn.theta += 0.1;
        break;
      case "ArrowUp":
        turn.phi -= 0.1;
        break;
      case "ArrowDown":
        turn.phi += 0.1;
        break;
      case "+":
      case "=":
        turn.radius /= 1.15;
        break;
      case "-":
        turn.radius *= 1.15;
        break;
      case "Home":
      case "0":
        this.reset();
        event.preventDefault();
        return;
      default:
        return;
    }
    event.preventDefault();
    turn.makeSafe();
    arm.setFromSpherical(turn);
    this.camera.position.set(arm.z, arm.x, arm.y).add(this.controls.target);
    this.controls.update();
    this.draw();
  }
}
