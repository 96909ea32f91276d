import { BufferAttribute, BufferGeometry, Color, DataTexture, LinearFilter, Mesh, RedFormat, ShaderMaterial } from 'three';
import type { Part, PartContext } from '../part';
import { coarse, painter, plan_rings } from '../rings';
import { Shade, shade_size } from '../shade';

const colors = { dark: { color: 0x05090d, most: 0.8 }, light: { color: 0x24323f, most: 0.5 } };

/** The arm's shadow on the floor, which shows where it is in depth and whether it touches. */
export function make_shadow({ scene: { arm }, span, floor, theme }: PartContext): Part[] {
  if (!arm.visible) return [];
  const shade = new Shade(plan_rings({ ...arm, markers: [], tip: 'flat' }, painter(arm), coarse), span, floor);
  const texture = new DataTexture(shade.texels, shade_size, shade_size, RedFormat);
  texture.minFilter = texture.magFilter = LinearFilter;
  const corners = new BufferAttribute(new Float32Array(12), 3);
  const geometry = new BufferGeometry()
    .setAttribute('position', corners)
    .setAttribute('uv', new BufferAttribute(new Float32Array([0, 0, 1, 0, 1, 1, 0, 1]), 2));
  geometry.setIndex([0, 2, 1, 0, 3, 2]);
  const { color, most } = colors[theme];
  const material = new ShaderMaterial({
    uniforms: { map: { value: texture }, color: { value: new Color(color).convertLinearToSRGB() }, most: { value: most } },
    vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }',
    fragmentShader: 'varying vec2 at; uniform sampler2D map; uniform vec3 color; uniform float most;'
      + ' void main() { gl_FragColor = vec4(color, most * texture2D(map, at).r); }',
    transparent: true,
    depthWrite: false,
  });
  const mesh = new Mesh(geometry, material);
  mesh.frustumCulled = false;
  mesh.position.y = floor + 2e-4 * span;
  mesh.renderOrder = -5;
  mesh.raycast = () => {};
  return [{
    id: 'shadow',
    label: 'Shadow on the floor',
    group: mesh,
    draw({ samples }) {
      shade.lay(samples);
      const { left, right, near, far } = shade;
      corners.array.set([left, 0, near, right, 0, near, right, 0, far, left, 0, far]);
      corners.needsUpdate = true;
      texture.needsUpdate = true;
    },
    dispose() {
      geometry.dispose();
      material.dispose();
      texture.dispose();
    },
  }];
}
