// How points look: discs lit from a little above the eye.

import { UNFOLD } from "../shared/unfold";

export const VERTEX = `
attribute vec2 oct;
attribute vec3 rgb;
attribute float label;
attribute float said;
attribute float value;
uniform int mode;         // 0 labels, 1 rgb, 2 normals, 3 prediction, 4 ramp, 5 none
uniform bool paint;       // painted points over everything
uniform vec3 palette[9];  // by class, and none
uniform sampler2D ramp;
uniform float hidden[8];  // 1 for a class that is hidden
uniform bool clipped;
uniform vec3 clipMin;
uniform vec3 clipMax;
uniform float pixels;     // height of one unit at distance one
uniform float spacings[8];
uniform float size;       // of a point, in spacings
uniform float least;      // of a point, in pixels
varying vec3 colour;
varying float rim;

${UNFOLD}
bool isHidden(float c) {
  return c < 7.5 && hidden[int(c + 0.5)] > 0.5;
}

void main() {
  vec3 place = (modelMatrix * vec4(position, 1.0)).xyz;
  bool outside = clipped && (any(lessThan(place, clipMin)) || any(greaterThan(place, clipMax)));
  if (outside || isHidden(label) || isHidden(said)) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    gl_PointSize = 1.0;
    return;
  }
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  vec3 normal = unfold(oct);
  float light = abs(dot(normalize(normalMatrix * normal), normalize(vec3(0.25, 0.45, 1.0))));
  float shade = mix(0.55, 1.0, light);
  bool painted = label < 7.5 && (paint || mode == 0);
  if (painted) colour = palette[int(label + 0.5)] * mix(0.86, 1.0, light);
  else if (mode == 1) colour = rgb * mix(0.8, 1.0, light);
  else if (mode == 2) colour = (normal * 0.5 + 0.5) * mix(0.8, 1.0, light);
  else if (mode == 3 && said < 7.5) colour = palette[int(said + 0.5)] * mix(0.5, 0.92, light);
  else if (mode == 4) colour = texture2D(ramp, vec2((value * 255.0 + 0.5) / 256.0, 0.5)).rgb * mix(0.72, 1.0, light);
  else colour = palette[8] * shade;
  gl_Position = projectionMatrix * seen;
  int octant = (position.x >= 0.5 ? 1 : 0) + (position.y >= 0.5 ? 2 : 0) + (position.z >= 0.5 ? 4 : 0);
  float wide = size * spacings[octant] * pixels / -seen.z;
  gl_PointSize = clamp(wide * (painted ? 1.3 : 1.0), painted ? least + 1.0 : least, 48.0);
  rim = painted && mode != 0 && gl_PointSize > 6.0 ? 1.0 : 0.0;
}`;

export const FRAGMENT = `
varying vec3 colour;
varying float rim;
void main() {
  vec2 p = gl_PointCoord - 0.5;
  float away = dot(p, p);
  if (away > 0.25) discard;
  gl_FragColor = vec4(rim > 0.5 && away > 0.19 ? mix(colour, vec3(0.1, 0.42, 0.95), 0.6) : colour, 1.0);
}`;
