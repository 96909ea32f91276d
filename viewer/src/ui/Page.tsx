import { LeftPanel } from '../panels/LeftPanel';
import { RightPanel } from '../panels/RightPanel';
import { Plots } from '../plots/Plots';
import { Stage3D } from '../scene/Stage3D';
import { StageNotes } from '../scene/StageNotes';
import { preferences } from '../state/preferences';
import { Teach } from '../teach/Teach';
import { Timeline } from '../timeline/Timeline';
import { use_app } from './app';
import { Entrance } from './Entrance';
import { Examples } from './Examples';
import { Header } from './Header';
import { Help } from './Help';
import { NoticeList } from './NoticeList';

export function Page() {
  const app = use_app();
  return (
    <>
      <Header />
      {app.route.value === 'teach' ? <Teach /> : <Bench />}
      <NoticeList />
      <Help />
      <Examples />
    </>
  );
}

function Bench() {
  const { viewer } = use_app();
  return (
    <main class="bench" data-plots={preferences.show_plots.value} data-freshness={viewer.freshness.value}>
      <LeftPanel />
      <section class="stage" aria-label="3D view">
        <Stage3D />
        <StageNotes />
        <Entrance />
      </section>
      <RightPanel />
      {preferences.show_plots.value && <Plots />}
      <Timeline />
    </main>
  );
}
