// Anti-aliasing is the most expensive part of software rendering. There, moving scenes are drawn without it, and a
// scene at rest is drawn once more at twice the resolution.
import type { WebGLRenderer } from 'three';

const rest_ms = 250;

/** Returns whether this browser renders WebGL without a graphics card. */
export function draws_in_software(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return false;
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

export class Sharpness {
  private ratio: number;
  private wanted: number;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly software: boolean,
    private readonly redraw: () => void,
  ) {
    this.ratio = this.wanted = software ? 1 : Math.min(2, devicePixelRatio);
  }

  /** Something has moved. */
  moved(): void {
    if (!this.software) return;
    this.wanted = 1;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      this.wanted = 2;
      this.redraw();
    }, rest_ms);
  }

  /** Called before each frame. */
  apply(renderer: WebGLRenderer, first = false): void {
    if (!first && this.ratio === this.wanted) return;
    this.ratio = this.wanted;
    renderer.setPixelRatio(this.ratio);
  }

  stop(): void {
    clearTimeout(this.timer);
  }
}
