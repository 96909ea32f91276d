import { useSignal } from '@preact/signals';
import { use_app } from '../ui/app';
import { CameraCard } from './CameraCard';
import { MeasurePanel } from './MeasurePanel';
import { PixelInspector } from './PixelInspector';
import type { Pixel } from './pixel_value';

/** Camera pictures and measures. */
export function RightPanel() {
  const { viewer } = use_app();
  const pixel = useSignal<Pixel | null>(null);
  const cameras = viewer.scene.value?.cameras ?? [];
  return (
    <aside class="right" aria-label="Cameras">
      <div class="cards" data-count={cameras.length}>
        {cameras.map((camera) => <CameraCard key={camera.name} camera={camera} pixel={pixel} />)}
        {!cameras.length && <p class="empty">{viewer.scene.value ? 'This rig has no cameras.' : 'No data received yet.'}</p>}
      </div>
      {cameras.length > 0 && <MeasurePanel cameras={cameras.length} />}
      {cameras.length > 0 && <PixelInspector pixel={pixel} />}
    </aside>
  );
}
