// The background: a gradient, drawn as one triangle at the far end, after everything that is opaque: what is hidden costs
// nothing. Its colours go to the picture unchanged (plain.ts says why).
import { BufferAttribute, BufferGeometry, Color, Mesh, ShaderMaterial } from 'three';
import type { Theme } from './part';

const colors = { dark: { low: 0x36454f, high: 0x131b23 }, light: { low: 0xfafbfc, high: 0xd5dee7 } };

export class Backdrop {
  readonly mesh: Mesh;
  private readonly material: ShaderMaterial;

  constructor() {
    const corners = new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3);
    this.material = new ShaderMaterial({
      uniforms: { low: { value: new Color() }, high: { value: new Color() } },
      vertexShader: 'varying vec3 shade; uniform vec3 low; uniform vec3 high; void main() {'
        + ' shade = mix(low, high, position.y * 0.5 + 0.5); gl_Position = vec4(position.xy, 0.9999999, 1.0); }',
      fragmentShader: 'varying vec3 shade; void main() { gl_FragColor = vec4(shade, 1.0); }',
      depthWrite: false,
    });
    this.mesh = new Mesh(new BufferGeometry().setAttribute('position', corners), this.material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 100;
    // It is no thing that can be clicked.
    this.mesh.raycast = () => {};
  }

  set_theme(theme: Theme): void {
    this.material.uniforms.low.value.set(colors[theme].low).convertLinearToSRGB();
    this.material.uniforms.high.value.set(colors[theme].high).convertLinearToSRGB();
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.material.dispose();
  }
}
