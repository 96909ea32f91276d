import { useEffect, useRef } from 'preact/hooks';
import { effect, signal, type Signal } from '@preact/signals';
import type { PixelResult } from '../protocol/types';
import { total_length } from '../scene/rings';
import { use_app } from '../ui/app';
import { fixed, length_places } from '../ui/format';
import { follow_pixel, type Pixel } from './pixel_value';

/** Size of the enlarged area: pixels on each side of the inspected one. */
const around = 7;

/** Shows the exact pixel value of the camera, not that of the compressed picture on the screen. */
export function PixelInspector({ pixel }: { pixel: Signal<Pixel | null> }) {
  const { viewer } = use_app();
  const canvas = useRef<HTMLCanvasElement>(null);
  const result = useRef(signal<PixelResult | null>(null)).current;
  useEffect(() => follow_pixel(viewer, pixel, result), []);
  useEffect(() => effect(() => {
    viewer.picture_tick.value;
    const at = pixel.value;
    enlarge(canvas.current!, at, at ? (viewer.picture_of.get(at.camera)?.bitmap ?? null) : null);
  }), []);
  const at = pixel.value;
  const exact = result.value;
  const is_file = viewer.hello.value?.mode === 'pictures';
  const places = viewer.scene.value ? length_places(total_length(viewer.scene.value.arm)) : 3;
  return (
    <section class="pixel" aria-label="Pixel inspector">
      <canvas ref={canvas} width={2 * around + 1} height={2 * around + 1} aria-hidden="true" />
      <dl>
        <div><dt>Pixel</dt><dd>{at ? `${at.camera} (${at.u}, ${at.v})` : 'point at a picture'}</dd></div>
        <div><dt>Value</dt><dd>{exact ? `${exact.value.join(', ')} of ${2 ** exact.bits - 1}` : '–'}</dd></div>
        {!is_file && <div><dt>Is</dt><dd>{what_is(exact, places)}</dd></div>}
        {!is_file && <div><dt>Depth</dt><dd>{exact && exact.depth !== null ? `${fixed(exact.depth, places)} m` : '–'}</dd></div>}
      </dl>
    </section>
  );
}

/** Describes the object at the pixel, if known; it is unknown for pictures of real cameras. */
function what_is(exact: PixelResult | null, places: number): string {
  if (!exact?.label) return '–';
  return exact.label + (exact.s === null ? '' : ` at s ${fixed(exact.s, places)} m`);
}

function enlarge(canvas: HTMLCanvasElement, at: Pixel | null, bitmap: ImageBitmap | null): void {
  const context = canvas.getContext('2d');
  if (!context) return;
  const size = 2 * around + 1;
  context.clearRect(0, 0, size, size);
  if (!at || !bitmap) return;
  context.imageSmoothingEnabled = false;
  context.drawImage(bitmap, at.u - around, at.v - around, size, size, 0, 0, size, size);
}
