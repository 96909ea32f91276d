// Materials that show their colour as it is, unlit. Those of three work in linear light and convert each pixel, with a
// power for each channel: where the processor draws, that is much of what screens and pictures cost. Here the colour
// is converted once, and a picture's texture not at all.
import type { LineBasicMaterial, MeshBasicMaterial } from 'three';

/** To be done when it is made: a colour that is set later is not converted. */
export function plain<M extends MeshBasicMaterial | LineBasicMaterial>(material: M): M {
  material.color.convertLinearToSRGB();
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace('#include <colorspace_fragment>', '');
  };
  material.customProgramCacheKey = () => 'plain';
  return material;
}
