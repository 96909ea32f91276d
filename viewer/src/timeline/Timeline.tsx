import type { Mark } from '../protocol/types';
import { speeds } from '../state/playback';
import { use_app } from '../ui/app';
import { format_time } from '../ui/format';
import { Icon } from '../ui/Icon';
import { lane_of, run_end_in, type Bar } from './bars';
import { name_of } from './labels';

/** Timeline: play, pause, step, speed, and a scrub bar with marks for events. */
export function Timeline() {
  const { viewer } = use_app();
  const { playback } = viewer;
  const live = playback.mode.value === 'live';
  const running = playback.running.value;
  const ready = viewer.hello.value !== null;
  return (
    <section class="timeline" aria-label="Timeline">
      <div class="transport" role="group" aria-label="Playback">
        <button type="button" class="button quiet square" disabled={!ready} aria-label="One step back" title="One step back (←)"
          onClick={() => playback.step(-1)}><Icon name="back" /></button>
        <button type="button" class="button square" disabled={!ready} id="play"
          aria-label={running ? (live ? 'Hold the view' : 'Pause') : live ? 'Back to now' : 'Play'} title={running ? 'Hold or pause (Space)' : 'Play, or back to now (Space)'}
          onClick={() => playback.toggle()}><Icon name={running ? 'pause' : 'play'} /></button>
        <button type="button" class="button quiet square" disabled={!ready} aria-label="One step forward" title="One step forward (→)"
          onClick={() => playback.step(1)}><Icon name="next" /></button>
        {live ? (
          <button type="button" class="button live-button" title="Back from an earlier time to the present" disabled={!ready || playback.held.value === null}
            onClick={() => playback.go_live()}>Now</button>
        ) : (
          <select aria-label="Speed" title="Slower or faster (− +)" value={playback.speed.value}
            onChange={(event) => (playback.speed.value = Number(event.currentTarget.value))}>
            {speeds.map((speed) => <option key={speed} value={speed}>{speed}×</option>)}
          </select>
        )}
      </div>
      <Line />
    </section>
  );
}

function Line() {
  const { viewer, cursor } = use_app();
  const { playback, history } = viewer;
  viewer.tick.value;
  const live = playback.mode.value === 'live';
  const newest = history.newest?.time ?? 0;
  const from = live ? Math.max(history.oldest?.time ?? 0, newest - history.seconds) : 0;
  const to = live ? newest : playback.duration.value;
  const time = live ? (playback.held.value ?? newest) : playback.time.value;
  // The spoken time is that of the shown state, as everywhere on the page; it may be slightly before the requested one.
  const said = format_time(viewer.shown?.time ?? time);
  const part = (t: number): string => `${(100 * Math.min(1, Math.max(0, (t - from) / Math.max(1e-9, to - from)))).toFixed(3)}%`;
  const marks = marks_of(viewer.hello.value?.marks ?? [], viewer.events.value);
  const end_of = live ? (start: number) => run_end_in(history, start) : () => to;
  const { bars, labels } = lane_of(marks.filter((mark) => !is_band(mark)), end_of, from, to);
  const bands = marks.filter((mark) => is_band(mark) && mark.end >= from && mark.time <= to);
  const hover = cursor.value;
  return (
    <>
      <output class="time" id="time" aria-live="off">{viewer.freshness.value === 'live' ? 'now' : ''} {said}</output>
      <div class="line">
        <input type="range" id="scrub" aria-label="Time" title="The time that is shown" min={from} max={Math.max(to, from + 1e-9)} step="any" value={time}
          aria-valuetext={said}
          onInput={(event) => {
            if (!live) playback.pause();
            playback.seek(event.currentTarget.valueAsNumber);
          }} />
        <div class="rail" aria-hidden="true">
          <span class="done" style={{ width: part(time) }} />
          {hover !== null && hover >= from && hover <= to && <span class="hover" style={{ left: part(hover) }} />}
        </div>
        <div class="marks">
          {bars.map((bar, i) => <TaskBar key={i} bar={bar} part={part} from={from} to={to} />)}
          {labels.map((label, i) => (
            <MarkButton key={i} marks={label.marks} time={label.marks[0].time} is_span={label.end > label.time} words={name_of(label)}
              left={part(label.time)} width={`calc(${part(label.until)} - ${part(label.time)})`} />
          ))}
          {bands.map((mark, i) => (
            <MarkButton key={i} marks={[mark]} time={mark.time} is_span={mark.end > mark.time}
              left={part(mark.time)} width={`calc(${part(mark.end)} - ${part(mark.time)})`} />
          ))}
        </div>
      </div>
      <output class="time end" aria-live="off">{live ? `last ${Math.round(to - from)} s` : format_time(to)}</output>
    </>
  );
}

/** Returns whether a mark is a warning; warnings have a separate lane without labels. */
function is_band({ level }: Mark): boolean {
  return level !== 'info';
}

interface TaskBarProps {
  bar: Bar;
  part(time: number): string;
  from: number;
  to: number;
}

/** A task: from its start to its end, with ticks for what happened in it. */
function TaskBar({ bar: { name, kind, start, end, ticks }, part, from, to }: TaskBarProps) {
  const [left, right] = [Math.max(from, start), Math.min(to, end)];
  const words = kind ? `${name} (${kind})` : name;
  return (
    <>
      <MarkButton marks={[{ time: start, end, level: 'info', name, text: '' }]} time={left} is_span words={name} is_task
        title={`${words}: ${format_time(start)} to ${format_time(end)}`} left={part(left)} width={`calc(${part(right)} - ${part(left)})`} />
      {ticks.map((tick, i) => (
        <MarkButton key={i} marks={tick.marks} time={tick.marks[0].time} is_span={false} is_tick left={part(tick.time)} width="" />
      ))}
    </>
  );
}

interface MarkButtonProps {
  marks: Mark[];
  time: number;
  is_span: boolean;
  left: string;
  width: string;
  words?: string;
  is_task?: boolean;
  /** It stands in the bar of a task. */
  is_tick?: boolean;
  title?: string;
}

function MarkButton({ marks, time, is_span, left, width, words, is_task, is_tick, title }: MarkButtonProps) {
  const { viewer } = use_app();
  return (
    <button type="button" class={is_tick ? 'tick' : 'mark'} data-task={is_task} data-level={marks[0].level} data-span={is_span} tabIndex={-1} style={{ left, width }}
      title={title ?? marks.map((mark) => `${format_time(mark.time)}  ${mark.name}${mark.text ? `: ${mark.text}` : ''}`).join('\n')}
      aria-label={title ?? marks.map((mark) => `${mark.level}: ${mark.name} at ${format_time(mark.time)}`).join('; ')}
      // Does not take the focus: Space must then play, not activate the mark again.
      onMouseDown={(event) => event.preventDefault()} onClick={() => viewer.playback.seek(time)}>
      {words !== undefined && <span>{words}</span>}
    </button>
  );
}

/** Longer ones first: shorter ones lie upon them. */
function marks_of(marks: Mark[], events: Omit<Mark, 'end'>[]): Mark[] {
  return [...marks, ...events.map((event) => ({ ...event, end: event.time }))].sort((a, b) => (b.end - b.time) - (a.end - a.time));
}
