// A camera that turns, slides and comes nearer about a picked point.

import { PerspectiveCamera, Quaternion, Vector3 } from "three";
import type { View } from "./detail";
import { boxCentre, boxDiagonal } from "./geometry";
import type { Box, Vec3 } from "./types";

const FIELD_OF_VIEW = 40;
const FLIGHT_MS = 350;
/** The part of the view that a cloud fills, so that the words over it have room. */
const SHARE = 0.82;
const HOME = new Vector3(-0.55, -1, 0.7).normalize();

/** From where, and what is up. */
const SIDES: Record<Side, [Vec3, Vec3]> = {
  top: [
    [0, 0, 1],
    [0, 1, 0],
  ],
  bottom: [
    [0, 0, -1],
    [0, 1, 0],
  ],
  front: [
    [0, -1, 0],
    [0, 0, 1],
  ],
  back: [
    [0, 1, 0],
    [0, 0, 1],
  ],
  right: [
    [1, 0, 0],
    [0, 0, 1],
  ],
  left: [
    [-1, 0, 0],
    [0, 0, 1],
  ],
};
export type Side = "top" | "bottom" | "front" | "back" | "right" | "left";

const HALF_VIEW = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
/** An orthographic view is one from so many radii away: its rays differ by a third of a degree at most. */
const FAR_AWAY = 200;

/** Where it is, how it is turned, and how far away what it looks at is. */
export interface Pose {
  position: Vec3;
  turn: [number, number, number, number];
  distance: number;
}

export class Camera {
  /** What is drawn with. */
  readonly three = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 10);
  /** What is moved: the same, but for an orthographic view, which follows it. */
  private readonly rig = new PerspectiveCamera();
  private middle = new Vector3();
  private radius = 1;
  private height = 1;
  private distance = 1;
  private flight = 0;
  private flat = false;

  constructor(private readonly moved: () => void) {
    this.three.up.set(0, 0, 1);
  }

  resize(width: number, height: number): void {
    this.height = height;
    this.three.aspect = width / Math.max(height, 1);
    this.changed();
  }

  setBounds(box: Box): void {
    this.middle.set(...boxCentre(box));
    this.radius = Math.max(boxDiagonal(box) / 2, 1e-9);
  }

  /** Parallel lines stay parallel. */
  setOrthographic(on: boolean): void {
    this.flat = on;
    this.changed();
  }

  /** So many times farther away than in perspective. */
  get stretch(): number {
    return this.flat ? (FAR_AWAY * this.radius) / this.distance : 1;
  }

  /** Height in CSS pixels of one unit at distance one. */
  get pixels(): number {
    return (this.height / (2 * HALF_VIEW)) * this.stretch;
  }

  get view(): View {
    const matrix = this.three.projectionMatrix.clone().multiply(this.three.matrixWorldInverse).elements;
    return { matrix, eye: this.three.position.toArray() as Vec3, pixels: this.pixels };
  }

  get pose(): Pose {
    const { position, quaternion } = this.rig;
    const { x, y, z, w } = quaternion;
    return { position: position.toArray() as Vec3, turn: [x, y, z, w], distance: this.distance };
  }

  set pose({ position, turn, distance }: Pose) {
    ++this.flight;
    this.rig.position.set(...position);
    this.rig.quaternion.set(...turn);
    this.distance = distance;
    this.changed();
  }

  /** Ends a flight where it is. */
  stop(): void {
    ++this.flight;
  }

  /** Where the view is centred, as far as what was last looked at. */
  get target(): Vec3 {
    return this.forward().multiplyScalar(this.distance).add(this.rig.position).toArray() as Vec3;
  }

  private forward(): Vector3 {
    return new Vector3(0, 0, -1).applyQuaternion(this.rig.quaternion);
  }

  /** All of some places, as near as they are seen whole: from the first direction, a side or where the camera is. */
  fit(from: Side | "first" | "here", places: ArrayLike<number>): void {
    const [back, up] =
      from === "first"
        ? [HOME.clone(), new Vector3(0, 0, 1)]
        : from === "here"
          ? [this.forward().negate(), new Vector3(0, 1, 0).applyQuaternion(this.rig.quaternion)]
          : SIDES[from].map((axis) => new Vector3(...axis));
    const right = new Vector3().crossVectors(up, back).normalize();
    const above = new Vector3().crossVectors(back, right);
    const { x, y, away, depth } = framed(places, [right, above, back], HALF_VIEW * this.three.aspect, HALF_VIEW);
    const plane = right.multiplyScalar(x).addScaledVector(above, y);
    const to = plane.clone().addScaledVector(back, away);
    this.fly(to, plane.addScaledVector(back, Math.min(depth, away - this.radius * 1e-3)), above, from === "first");
  }

  /** How far from a place to look at it: not so far that the whole cloud is small. */
  nearby(distance: number): number {
    return Math.min(distance, 1.5 * this.radius);
  }

  /** To a place on the surface, from outside along its normal. */
  visit(place: Vec3, normal: Vec3, distance: number): void {
    const target = new Vector3(...place);
    const back = new Vector3(...normal);
    const now = this.forward().negate();
    // A little aslant, from the side where the camera is: edges show better so.
    if (back.dot(now) < 0 && back.lengthSq() < 0.5) back.copy(now);
    back.normalize().multiplyScalar(0.8).addScaledVector(now, 0.35).normalize();
    const up = new Vector3(0, 0, 1);
    if (Math.abs(back.dot(up)) > 0.95) up.set(0, 1, 0);
    this.fly(target.clone().addScaledVector(back, distance), target, up, false);
  }

  private fly(to: Vector3, target: Vector3, up: Vector3, atOnce: boolean): void {
    const goal = this.rig.clone();
    goal.position.copy(to);
    goal.up.copy(up);
    goal.lookAt(target);
    this.distance = to.distanceTo(target);
    const [from, turned] = [this.rig.position.clone(), this.rig.quaternion.clone()];
    const place = (share: number): void => {
      this.rig.position.lerpVectors(from, to, share);
      this.rig.quaternion.slerpQuaternions(turned, goal.quaternion, share);
      this.changed();
    };
    const flight = ++this.flight;
    if (atOnce || matchMedia("(prefers-reduced-motion: reduce)").matches) return place(1);
    const start = performance.now();
    const step = (): void => {
      if (flight !== this.flight) return;
      const share = Math.min((performance.now() - start) / FLIGHT_MS, 1);
      place(share * share * (3 - 2 * share));
      if (share < 1) requestAnimationFrame(step);
    };
    step();
  }

  /** Turns about a place by angles to the right and down the screen. */
  turn(right: number, down: number, about: Vec3): void {
    ++this.flight;
    const pivot = new Vector3(...about);
    const axis = (x: number, y: number): Vector3 => new Vector3(x, y, 0).applyQuaternion(this.rig.quaternion);
    const by = new Quaternion()
      .setFromAxisAngle(axis(0, 1), -right)
      .multiply(new Quaternion().setFromAxisAngle(axis(1, 0), -down));
    this.rig.position.sub(pivot).applyQuaternion(by).add(pivot);
    this.rig.quaternion.premultiply(by).normalize();
    this.changed();
  }

  /** Turns about the line of sight. */
  roll(angle: number): void {
    ++this.flight;
    this.rig.quaternion.premultiply(new Quaternion().setFromAxisAngle(this.forward(), angle)).normalize();
    this.changed();
  }

  /** Slides by pixels of the screen at the depth of a place. */
  slide(right: number, down: number, at: Vec3): void {
    ++this.flight;
    const depth = Math.max(new Vector3(...at).sub(this.rig.position).dot(this.forward()), this.radius * 1e-4);
    const step = (this.flat ? this.distance : depth) / (this.height / (2 * HALF_VIEW));
    this.rig.position.add(new Vector3(-right * step, down * step, 0).applyQuaternion(this.rig.quaternion));
    this.changed();
  }

  /** Comes nearer to a place by a factor, which stays where it is on the screen. */
  approach(factor: number, to: Vec3): void {
    ++this.flight;
    const pivot = new Vector3(...to);
    const arm = this.rig.position.clone().sub(pivot);
    const length = arm.length();
    const wanted = Math.min(Math.max(length * factor, this.radius * 1e-4), this.radius * 20);
    this.rig.position.copy(pivot).addScaledVector(arm, wanted / Math.max(length, 1e-12));
    this.distance *= wanted / Math.max(length, 1e-12);
    this.changed();
  }

  private changed(): void {
    const { three, rig, stretch } = this;
    three.quaternion.copy(rig.quaternion);
    three.position.copy(rig.position).addScaledVector(this.forward(), this.distance * (1 - stretch));
    three.fov = (360 / Math.PI) * Math.atan(HALF_VIEW / stretch);
    const away = three.position.distanceTo(this.middle);
    three.near = Math.max(away - this.radius * 1.05, this.radius * 2e-4, away * 1e-4);
    three.far = away + this.radius * 1.2;
    three.updateProjectionMatrix();
    three.updateMatrixWorld(true);
    this.moved();
  }
}

/** Where a camera is, along its own axes, that sees all places within the middle of its view. */
function framed(
  places: ArrayLike<number>,
  axes: Vector3[],
  halfWidth: number,
  halfHeight: number,
): { x: number; y: number; away: number; depth: number } {
  const [tx, ty] = [halfWidth * SHARE, halfHeight * SHARE];
  const most = { right: -Infinity, left: -Infinity, top: -Infinity, bottom: -Infinity };
  let [near, far] = [-Infinity, Infinity];
  const place = new Vector3();
  for (let i = 0; i < places.length; i += 3) {
    place.set(places[i], places[i + 1], places[i + 2]);
    const [x, y, z] = axes.map((axis) => axis.dot(place));
    most.right = Math.max(most.right, x + tx * z);
    most.left = Math.max(most.left, tx * z - x);
    most.top = Math.max(most.top, y + ty * z);
    most.bottom = Math.max(most.bottom, ty * z - y);
    near = Math.max(near, z);
    far = Math.min(far, z);
  }
  const away = Math.max((most.right + most.left) / (2 * tx), (most.top + most.bottom) / (2 * ty));
  return {
    x: (most.right - most.left) / 2,
    y: (most.top - most.bottom) / 2,
    away: Math.max(away, near + (near - far) * 1e-3 + 1e-9),
    depth: (near + far) / 2,
  };
}
