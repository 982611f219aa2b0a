// Eye-dome lighting: pixels that lie behind their neighbours get darker, so that shapes stand out
// without any normals (Boucheny 2009; Potree and CloudCompare have it).

import {
  BufferAttribute,
  BufferGeometry,
  DepthTexture,
  Mesh,
  NearestFilter,
  OrthographicCamera,
  Scene,
  ShaderMaterial,
  UnsignedIntType,
  Vector2,
  Vector3,
  WebGLRenderTarget,
  type PerspectiveCamera,
  type WebGLRenderer,
} from "three";

/** Pixels to the neighbours that are looked at, and how dark a step of depth makes. */
const REACH = 1.4;
const STRENGTH = 100;
/** No step counts for more: gaps between points are no cliffs. */
const MOST = 0.02;

const VERTEX = `
varying vec2 at;
void main() {
  at = position.xy * 0.5 + 0.5;
  gl_Position = vec4(position.xy, 0.0, 1.0);
}`;

const FRAGMENT = `
uniform sampler2D picture;
uniform sampler2D depths;
uniform vec2 pixel;
uniform vec2 range;       // the camera's near and far
uniform float stretch;    // how much farther away than in perspective
uniform vec3 background;
varying vec2 at;

// The logarithm of the distance: a step counts by how large it is compared with the distance.
float away(float depth) {
  return log2(range.x * range.y / (range.y - depth * (range.y - range.x)));
}

void main() {
  float depth = texture2D(depths, at).r;
  gl_FragDepth = depth;
  if (depth >= 1.0) {
    gl_FragColor = vec4(background, 1.0);
    return;
  }
  float own = away(depth);
  float sum = 0.0;
  for (int i = 0; i < 8; ++i) {
    float angle = 0.7853981634 * float(i);
    float other = texture2D(depths, at + pixel * vec2(cos(angle), sin(angle))).r;
    sum += clamp((own - away(min(other, 0.999999))) * stretch, 0.0, ${MOST});
  }
  gl_FragColor = vec4(texture2D(picture, at).rgb * exp(-${STRENGTH.toFixed(1)} * sum / 8.0), 1.0);
}`;

/** Gathers what is drawn and shows it with the lighting. */
export class EyeDome {
  private target: WebGLRenderTarget | null = null;
  private readonly material = new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    depthTest: false,
    uniforms: {
      picture: { value: null },
      depths: { value: null },
      pixel: { value: new Vector2() },
      range: { value: new Vector2() },
      stretch: { value: 1 },
      background: { value: new Vector3() },
    },
  });
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera();

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly ratio: number,
  ) {
    const triangle = new BufferGeometry();
    triangle.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    const mesh = new Mesh(triangle, this.material);
    mesh.frustumCulled = false;
    this.scene.add(mesh);
  }

  /** To the size of the canvas, in pixels of the card. */
  resize(width: number, height: number): void {
    this.target?.dispose();
    const depthTexture = new DepthTexture(width, height, UnsignedIntType);
    this.target = new WebGLRenderTarget(width, height, {
      minFilter: NearestFilter,
      magFilter: NearestFilter,
      depthTexture,
    });
    const u = this.material.uniforms;
    u.picture.value = this.target.texture;
    u.depths.value = depthTexture;
    u.pixel.value.set((REACH * this.ratio) / width, (REACH * this.ratio) / height);
  }

  /** What is drawn next is gathered. */
  begin(): void {
    this.renderer.setRenderTarget(this.target);
  }

  /** Shows what was gathered; the depths too, so that lines can be drawn into it. */
  show(camera: PerspectiveCamera, stretch: number, background: [number, number, number]): void {
    const u = this.material.uniforms;
    u.range.value.set(camera.near, camera.far);
    u.stretch.value = stretch;
    u.background.value.set(...background);
    this.renderer.setRenderTarget(null);
    this.renderer.clearDepth();
    this.renderer.render(this.scene, this.camera);
  }

  /** Nothing is gathered any more. */
  dispose(): void {
    this.target?.dispose();
    this.target = null;
  }
}
