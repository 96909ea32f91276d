import { useEffect } from 'preact/hooks';
import { RightPanel } from '../panels/RightPanel';
import { use_app } from './app';

/** Picture files alone. A single picture fills the page at once. */
export function PictureBench() {
  const { viewer, enlarged } = use_app();
  const epoch = viewer.epoch.value;
  useEffect(() => {
    const cameras = viewer.scene.peek()?.cameras ?? [];
    if (cameras.length !== 1) return;
    enlarged.value = viewer.finding.value = cameras[0].name;
  }, [epoch]);
  return (
    <main class="bench pictures" data-freshness={viewer.freshness.value}>
      <RightPanel />
    </main>
  );
}
