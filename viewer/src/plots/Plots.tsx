import { preferences } from '../state/preferences';
import { use_app } from '../ui/app';
import { LivePlot } from './LivePlot';
import { RecordingPlot } from './RecordingPlot';

/** Two plots side by side over one time. */
export function Plots() {
  const { viewer } = use_app();
  const hello = viewer.hello.value;
  const scene = viewer.scene.value;
  const places = [0, 1] as const;
  const kept = hello?.mode === 'recording' ? preferences.recording_plots : preferences.plots;
  const choose = (place: 0 | 1) => (id: string) => {
    const next: [string, string] = [...kept.value];
    next[place] = id;
    kept.value = next;
  };
  return (
    <section class="plots" aria-label="Plots">
      {hello && scene && places.map((place) => {
        const key = `${viewer.epoch.value} ${place}`;
        const props = { hello, place, chosen: kept.value[place], choose: choose(place) };
        return hello.mode === 'live' ? <LivePlot key={key} {...props} scene={scene} /> : <RecordingPlot key={key} {...props} />;
      })}
    </section>
  );
}
