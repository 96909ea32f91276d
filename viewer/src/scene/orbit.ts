// Viewpoint of the free view: a target, a distance and two angles, as in MuJoCo and Blender.
import { Vector3, type PerspectiveCamera } from 'three';

/** Limits of the distance, in lengths of the arm. */
const [nearest, farthest] = [0.02, 30];
const least_elevation = -Math.PI / 2 + 1e-3;

export class Orbit {
  readonly target = new Vector3();
  distance = 1;
  /** Length of the arm, the reference for distances. */
  span = 1;
  /** Angle around +Y from +Z towards +X, rad. */
  azimuth = 0.6;
  elevation = 0.34;
  private readonly side = new Vector3();
  private readonly up = new Vector3();

  turn(right: number, up: number): void {
    this.azimuth -= right;
    this.elevation = Math.min(-least_elevation, Math.max(least_elevation, this.elevation + up));
  }

  /** Moves the scene in the image plane, as shares of the view's height; the target moves the opposite way. */
  pan(camera: PerspectiveCamera, right: number, down: number): void {
    const height = 2 * this.distance * Math.tan((camera.fov * Math.PI) / 360);
    this.side.setFromMatrixColumn(camera.matrix, 0);
    this.up.setFromMatrixColumn(camera.matrix, 1);
    this.target.addScaledVector(this.side, -right * height).addScaledVector(this.up, down * height);
  }

  /** Zooms. The distance stays within limits that depend on the arm's length `span`. */
  zoom(factor: number): void {
    this.distance = Math.min(farthest * this.span, Math.max(nearest * this.span, this.distance * factor));
  }

  look(azimuth: number, elevation: number): void {
    this.azimuth = azimuth;
    this.elevation = elevation;
  }

  place(camera: PerspectiveCamera): void {
    const c = Math.cos(this.elevation);
    camera.position.set(
      this.target.x + this.distance * c * Math.sin(this.azimuth),
      this.target.y + this.distance * Math.sin(this.elevation),
      this.target.z + this.distance * c * Math.cos(this.azimuth),
    );
    camera.up.set(0, 1, 0);
    camera.lookAt(this.target);
    camera.near = this.distance / 100;
    camera.far = this.distance * 60;
  }
}
