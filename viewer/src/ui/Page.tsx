import { LeftPanel } from '../panels/LeftPanel';
import { RightPanel } from '../panels/RightPanel';
import { Plots } from '../plots/Plots';
import { Stage3D } from '../scene/Stage3D';
import { StageNotes } from '../scene/StageNotes';
import { preferences } from '../state/preferences';
import { Teach } from '../teach/Teach';
import { Timeline } from '../timeline/Timeline';
import { use_app } from './app';
import { Borders } from './Borders';
import { Entrance } from './Entrance';
import { Examples } from './Examples';
import { Experiment } from './Experiment';
import { Header } from './Header';
import { Help } from './Help';
import { Hints } from './Hints';
import { NoticeList } from './NoticeList';
import { PictureBench } from './PictureBench';

export function Page() {
  const app = use_app();
  return (
    <>
      <Header />
      {app.route.value === 'teach' ? <Teach /> : app.viewer.hello.value?.mode === 'pictures' ? <PictureBench /> : <Bench />}
      <NoticeList />
      <Help />
      <Examples />
      <Experiment />
    </>
  );
}

/** Where there is no room for all side by side. */
const narrow_tabs = [
  { id: 'view', label: '3D view', title: 'The arm in three dimensions' },
  { id: 'controls', label: 'Controls', title: 'Arm, cameras, scene and events' },
  { id: 'cameras', label: 'Pictures', title: 'What the cameras see' },
  { id: 'plots', label: 'Plots', title: 'Quantities over time' },
] as const;

function Bench() {
  const { viewer, narrow_tab } = use_app();
  return (
    <main class="bench" data-tab={narrow_tab.value} data-plots={preferences.show_plots.value} data-freshness={viewer.freshness.value}>
      <div class="narrow-tabs tabs" role="group" aria-label="What is shown">
        {narrow_tabs.map(({ id, label, title }) => (
          <button key={id} type="button" aria-pressed={narrow_tab.value === id} title={title} onClick={() => (narrow_tab.value = id)}>{label}</button>
        ))}
      </div>
      <LeftPanel />
      <div class="middle">
        <section class="stage" aria-label="3D view">
          <Stage3D />
          <StageNotes />
          <Entrance />
        </section>
        <Hints />
      </div>
      <RightPanel />
      {(preferences.show_plots.value || narrow_tab.value === 'plots') && <Plots />}
      <Borders />
      <Timeline />
    </main>
  );
}
