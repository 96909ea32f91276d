// Unlit materials that show their colour unchanged. The materials of three.js work in linear light and convert each
// pixel with a power function per channel, which is slow in software renderers. Here the colour is converted once, and
// a picture's texture is not converted.
import type { LineBasicMaterial, MeshBasicMaterial } from 'three';

/** Call it on creation: a colour that is set later is not converted. */
export function plain<M extends MeshBasicMaterial | LineBasicMaterial>(material: M): M {
  material.color.convertLinearToSRGB();
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace('#include <colorspace_fragment>', '');
  };
  material.customProgramCacheKey = () => 'plain';
  return material;
}
