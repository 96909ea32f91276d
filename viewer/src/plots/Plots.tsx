import { useEffect } from 'preact/hooks';
import type { Hello, Scene } from '../protocol/types';
import { preferences } from '../state/preferences';
import { use_app } from '../ui/app';
import { AlongPlot } from './AlongPlot';
import { LivePlot } from './LivePlot';
import { RecordingPlot } from './RecordingPlot';
import { along_option, can_be_along, live_sources, shown_groups } from './sources';

/** Returns everything that a plot can show. */
export function options_of(hello: Hello, scene: Scene): { id: string; label: string; unit: string }[] {
  const over_time = hello.mode === 'live' ? live_sources(hello, scene) : shown_groups(hello);
  return can_be_along(hello) ? [...over_time, along_option] : over_time;
}

/** Two plots side by side with a common time axis. */
export function Plots() {
  const { viewer, zoom } = use_app();
  const epoch = viewer.epoch.value;
  // Another run has other times.
  useEffect(() => {
    zoom.value = null;
  }, [epoch]);
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
        const props = { hello, place, chosen: kept.value[place], choose: choose(place), options: options_of(hello, scene) };
        if (can_be_along(hello) && kept.value[place] === along_option.id) {
          return <AlongPlot key={key} place={place} choose={choose(place)} options={options_of(hello, scene)} />;
        }
        return hello.mode === 'live' ? <LivePlot key={key} {...props} scene={scene} /> : <RecordingPlot key={key} {...props} />;
      })}
    </section>
  );
}
