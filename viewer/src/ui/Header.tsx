import { useSignal } from '@preact/signals';
import { flag_pace, flag_weightless } from '../protocol/state';
import { preferences, theme_now, toggle_theme } from '../state/preferences';
import { edit_experiment, use_app } from './app';
import { ConditionBadge } from './ConditionBadge';
import { duration_text, fixed, format_time } from './format';
import { Icon } from './Icon';

const badges = {
  live: ['LIVE', 'The current state is shown.'],
  held: ['HELD', 'The view is held at an earlier time; the rig keeps running.'],
  pictures: ['PICTURES', 'Picture files: there is no rig.'],
  recording: ['RECORDING', 'Recording: the rig cannot be moved.'],
  stale: ['STALE', 'No new data: the shown state is outdated.'],
  lost: ['NO CONNECTION', 'Connection lost: the shown state is outdated.'],
  none: ['CONNECTING', 'No data received yet.'],
  refused: ['NO ACCESS', 'Access refused: open the address that the program printed.'],
} as const;

export function Header() {
  const app = use_app();
  const { viewer } = app;
  const hello = viewer.hello.value;
  const freshness = viewer.freshness.value;
  const [badge, meaning] = badges[freshness];
  const teaching = app.route.value === 'teach';
  return (
    <header class="header">
      <a class="brand" href="#/" aria-label="Flexura, the viewer" title="The viewer">
        <svg viewBox="0 0 32 32" aria-hidden="true"><path d="M8 27V18C8 9 14 5 19 5s7 4 7 7-2 5-5 5-4-2-4-4" /></svg>
        <span>Flexura</span>
      </a>
      <h1 class="title">{teaching ? 'The planar arm and its equations' : (hello?.title ?? '')}</h1>
      {!teaching && <span class="badge" data-kind={freshness} role="status" title={meaning}>{badge}</span>}
      {!teaching && <ConditionBadge />}
      {!teaching && (viewer.flags.value & flag_weightless) !== 0 && (
        <span class="badge" data-kind="weightless" role="status" title="Weight and loads are switched off in this simulation.">NO WEIGHT</span>
      )}
      {!teaching && (viewer.flags.value & flag_pace) !== 0 && <Pace />}
      <span class="spacer" />
      {!teaching && hello && hello.mode !== 'pictures' && <Rig />}
      <nav class="tools" aria-label="Page">
        {!teaching && (hello?.examples?.length ?? 0) > 0 && (
          <button type="button" class="button quiet" title="Opens an example" onClick={() => (app.dialog.value = 'examples')}>
            <Icon name="folder" />Examples
          </button>
        )}
        {!teaching && hello && hello.mode !== 'pictures' && (
          <button type="button" class="button quiet square" aria-label="Experiment" title="The text of the experiment: edit it, save it as a new file"
            disabled={viewer.link.status.value.kind !== 'open'} onClick={() => edit_experiment(app)}><Icon name="text" /></button>
        )}
        {teaching ? (
          <a class="button" href="#/" title="Back to the viewer"><Icon name="back" />Viewer</a>
        ) : (
          <a class="button quiet" href="#/teach" title="The planar arm and its equations"><Icon name="teach" />Learn</a>
        )}
        <button type="button" class="button quiet square" onClick={toggle_theme}
          aria-label={theme_now() === 'dark' ? 'Light colours' : 'Dark colours'} title="Light or dark (L)">
          <Icon name={theme_now() === 'dark' ? 'sun' : 'moon'} />
        </button>
        <button type="button" class="button quiet square" onClick={() => (app.dialog.value = 'help')}
          aria-label="Help and keys" title="Help (F1)"><Icon name="help" /></button>
      </nav>
    </header>
  );
}

/** Shows that the simulation is slower than real time. */
function Pace() {
  const { viewer } = use_app();
  viewer.tick.value;
  const pace = viewer.shown?.pace;
  return (
    <span class="badge" data-kind="slow" role="status"
      title="The simulation is slower than real time: the arm moves more slowly than in real time.">
      {pace ? `${fixed(pace, 2)} × REAL TIME` : 'SLOW'}
    </span>
  );
}

/** How fast tasks play: those that run, and the next. */
function RunSpeed({ running, disabled }: { running: boolean; disabled: boolean }) {
  const { viewer } = use_app();
  const { speed, session } = viewer.hello.value!;
  // A run of a terminal has a speed of its own.
  const chosen = useSignal<{ session: string; speed: number } | null>(null);
  if (typeof speed === 'number') {
    const now = chosen.value?.session === session ? chosen.value.speed : speed;
    return (
      <select aria-label="Speed of the tasks" title="Speed of the run relative to real time" disabled={disabled} value={now}
        onChange={async ({ currentTarget: { value } }) => {
          if (await viewer.commander.speed(Number(value))) chosen.value = { session, speed: Number(value) };
        }}>
        {!run_speeds.some((each) => each.speed === now) && <option value={now}>{`${now} ×`}</option>}
        {run_speeds.map((each) => <option key={each.speed} value={each.speed}>{each.label}</option>)}
      </select>
    );
  }
  return (
    <select aria-label="Speed of the tasks" title="Speed of the tasks relative to real time" disabled={disabled}
      value={preferences.run_speed.value}
      onChange={({ currentTarget: { value } }) => viewer.commander.run_speed(Number(value), running)}>
      {run_speeds.map(({ speed, label }) => <option key={speed} value={speed}>{label}</option>)}
    </select>
  );
}

const run_speeds = [
  { speed: 0.25, label: '0.25 ×' }, { speed: 1, label: '1 × real time' }, { speed: 4, label: '4 ×' },
  { speed: 0, label: 'As fast as possible' },
];

/** Tasks and what belongs to them. */
function Rig() {
  const { viewer } = use_app();
  const only = useSignal<number | null>(null);
  const hello = viewer.hello.value!;
  const { tasks } = hello.controls;
  const progress = viewer.progress.value;
  const running = progress !== null && !progress.done;
  const ask = (what: string) => () => void viewer.commander.plain(what);
  const connected = viewer.link.status.value.kind === 'open';
  const report = hello.report && (
    <a class="button quiet" href="report" target="_blank" rel="noopener"
      title={`The report of ${hello.campaign ? 'the campaign' : 'this run'}, in a tab of its own`}><Icon name="report" />Report</a>
  );
  if (hello.mode === 'recording') {
    viewer.tick.value;
    const instant = viewer.shown?.time ?? 0;
    return (
      <div class="tools">
        {hello.headline && <span class="headline" title={hello.headline}>{hello.headline}</span>}
        <button type="button" class="button" disabled={!connected} onClick={() => void viewer.commander.branch(viewer.shown?.time ?? 0)}
          title={`Opens a live rig that starts in the shown state, ${format_time(instant)}: the arm as commanded and the cameras, at rest. The recording stays.`}>
          <Icon name="run" />Start here
        </button>
        {report}
        {hello.rig && (
          <button type="button" class="button" disabled={!connected} onClick={ask('live')} title="Back from the recording to the live rig"><Icon name="live" />To the rig</button>
        )}
      </div>
    );
  }
  // The hello covers earlier runs; a run that has ended since is known from its last progress message.
  const recorded = hello.recording || (progress?.done === true && (progress.recording ?? progress.outcome !== 'failed'));
  const run = (): void => {
    const task = only.value !== null && only.value < tasks.length ? only.value : undefined;
    void viewer.commander.run(task);
  };
  return (
    <div class="tools">
      {running && (
        <span class="running">
          <span class="running-text" title={progress.what}>{progress.what}</span>
          {typeof progress.left === 'number' && <span class="running-left" title="Estimated from the progress so far">{`${duration_text(progress.left)} left`}</span>}
          <progress max={1} value={progress.fraction ?? 0} aria-label="Progress of the tasks" />
          <button type="button" class="button" disabled={!connected || viewer.readonly} onClick={ask('cancel')}
            title={viewer.readonly ? 'Only the terminal that started the run can end it' : 'The run ends early (C)'}>
            <Icon name="close" />Cancel
          </button>
        </span>
      )}
      {!running && tasks.length > 1 && (
        <select aria-label="Tasks to run" title="Run all tasks, or a single one" value={only.value ?? ''} disabled={!connected || viewer.readonly || viewer.blind}
          onChange={({ currentTarget: { value } }) => (only.value = value === '' ? null : Number(value))}>
          <option value="">All tasks</option>
          {tasks.map(({ name, kind }, i) => <option key={i} value={i}>{`${i + 1}: ${name === kind ? name : `${name} (${kind})`}`}</option>)}
        </select>
      )}
      {!running && tasks.length > 0 && (
        <button type="button" class="button primary" disabled={!connected || viewer.readonly || viewer.blind} onClick={run}
          title={tasks.map(({ name, kind }) => `${name} (${kind})`).join('\n')}>
          <Icon name="run" />Run tasks
        </button>
      )}
      {tasks.length > 0 && (!hello.readonly || running) && <RunSpeed running={running} disabled={!connected || viewer.blind} />}
      {recorded && !running && (
        <button type="button" class="button" disabled={!connected} onClick={() => void viewer.replay()}
          title="Opens the recording of the last run and plays it"><Icon name="film" />Replay</button>
      )}
      {report}
      {/* Halt stays enabled even if the rig does not answer. */}
      <button type="button" class="button danger" disabled={!connected || viewer.readonly} onClick={ask('halt')}
        title="Stops everything (H or F8, also while you type in a field)"><Icon name="halt" />Halt</button>
      <button type="button" class="button quiet" disabled={!connected || viewer.still} onClick={ask('reset')}
        title="Reset to the initial state (Backspace)"><Icon name="reset" />Reset</button>
    </div>
  );
}
