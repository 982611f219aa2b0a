// A camera that turns, slides and comes nearer about a picked point.

import { PerspectiveCamera, Quaternion, Vector3 } from "three";
import type { View } from "./detail";
import { boxCentre, boxDiagonal } from "./geometry";
import type { Box, Vec3 } from "./types";

const FIELD_OF_VIEW = 40;
const FLIGHT_MS = 350;
const HOME = new Vector3(-0.55, -1, 0.7).normalize();

export class Camera {
  readonly three = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 10);
  private middle = new Vector3();
  private radius = 1;
  private height = 1;
  private distance = 1;
  private flight = 0;

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

  /** Height in CSS pixels of one unit at distance one. */
  get pixels(): number {
    return this.height / (2 * Math.tan((FIELD_OF_VIEW * Math.PI) / 360));
  }

  get view(): View {
    const matrix = this.three.projectionMatrix.clone().multiply(this.three.matrixWorldInverse).elements;
    return { matrix, eye: this.three.position.toArray() as Vec3, pixels: this.pixels };
  }

  /** Where the view is centred, as far as what was last looked at. */
  get target(): Vec3 {
    return this.forward().multiplyScalar(this.distance).add(this.three.position).toArray() as Vec3;
  }

  private forward(): Vector3 {
    return new Vector3(0, 0, -1).applyQuaternion(this.three.quaternion);
  }

  /** All of a box, from the first direction or the present one. */
  fit(afresh: boolean, box?: Box): void {
    const centre = box ? new Vector3(...boxCentre(box)) : this.middle;
    const radius = box ? Math.max(boxDiagonal(box) / 2, 1e-9) : this.radius;
    const narrow = Math.min(1, this.three.aspect);
    const away = radius / Math.sin((FIELD_OF_VIEW * Math.PI) / 360) / narrow;
    const back = afresh ? HOME.clone() : this.forward().negate();
    const up = afresh ? new Vector3(0, 0, 1) : new Vector3(0, 1, 0).applyQuaternion(this.three.quaternion);
    this.fly(centre.clone().addScaledVector(back, away * 0.93), centre, up, afresh);
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
    const goal = this.three.clone();
    goal.position.copy(to);
    goal.up.copy(up);
    goal.lookAt(target);
    this.distance = to.distanceTo(target);
    const [from, turned] = [this.three.position.clone(), this.three.quaternion.clone()];
    const place = (share: number): void => {
      this.three.position.lerpVectors(from, to, share);
      this.three.quaternion.slerpQuaternions(turned, goal.quaternion, share);
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
    const axis = (x: number, y: number): Vector3 => new Vector3(x, y, 0).applyQuaternion(this.three.quaternion);
    const by = new Quaternion()
      .setFromAxisAngle(axis(0, 1), -right)
      .multiply(new Quaternion().setFromAxisAngle(axis(1, 0), -down));
    this.three.position.sub(pivot).applyQuaternion(by).add(pivot);
    this.three.quaternion.premultiply(by).normalize();
    this.changed();
  }

  /** Turns about the line of sight. */
  roll(angle: number): void {
    ++this.flight;
    this.three.quaternion.premultiply(new Quaternion().setFromAxisAngle(this.forward(), angle)).normalize();
    this.changed();
  }

  /** Slides by pixels of the screen at the depth of a place. */
  slide(right: number, down: number, at: Vec3): void {
    ++this.flight;
    const depth = Math.max(new Vector3(...at).sub(this.three.position).dot(this.forward()), this.radius * 1e-4);
    const step = depth / this.pixels;
    this.three.position.add(new Vector3(-right * step, down * step, 0).applyQuaternion(this.three.quaternion));
    this.changed();
  }

  /** Comes nearer to a place by a factor, which stays where it is on the screen. */
  approach(factor: number, to: Vec3): void {
    ++this.flight;
    const pivot = new Vector3(...to);
    const arm = this.three.position.clone().sub(pivot);
    const length = arm.length();
    const wanted = Math.min(Math.max(length * factor, this.radius * 1e-4), this.radius * 20);
    this.three.position.copy(pivot).addScaledVector(arm, wanted / Math.max(length, 1e-12));
    this.distance *= wanted / Math.max(length, 1e-12);
    this.changed();
  }

  private changed(): void {
    const away = this.three.position.distanceTo(this.middle);
    this.three.near = Math.max(away - this.radius * 1.05, this.radius * 2e-4, away * 1e-4);
    this.three.far = away + this.radius * 1.2;
    this.three.updateProjectionMatrix();
    this.three.updateMatrixWorld(true);
    this.moved();
  }
}
