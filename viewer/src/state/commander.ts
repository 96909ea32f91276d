// User commands to the rig. Each kind has one request outstanding, and only the newest one waits.
import { signal } from '@preact/signals';
import { Latest } from '../connection/latest';
import type { Link } from '../connection/link';
import type { ExperimentText, TextProblem, TipResult, Vector3 } from '../protocol/types';
import type { Notices } from './notices';
import type { Playback } from './playback';
import { preferences } from './preferences';
import type { Seeing } from './seeing';

export type ArmCommand = Record<string, unknown>;

export type Push = { s: number; to: Vector3 } | { s: number; force: Vector3 };

/** What is added to the text of an experiment: a task to the shown pose, or the view of a camera. */
export interface Addition {
  add?: 'pose' | 'view';
  camera?: string;
}

export class Commander {
  /** The last result of inverse kinematics and its target; null when the tip is not dragged. */
  readonly tip_result = signal<TipResult | null>(null);
  readonly tip_goal = signal<Vector3 | null>(null);
  private readonly arm_latest: Latest<ArmCommand>;
  private readonly tip_latest: Latest<Vector3, TipResult>;
  private readonly push_latest: Latest<Push>;
  private is_tip_led = false;
  private readonly axes = new Map<string, Latest<Record<string, unknown>>>();

  constructor(
    private readonly link: Link, private readonly notices: Notices, private readonly playback: Playback,
    private readonly seeing?: Pick<Seeing, 'all_sent'>,
  ) {
    const told = (_: unknown, error: Error | null): void => {
      if (error) notices.error(error);
    };
    this.arm_latest = new Latest<ArmCommand>((values) => link.request('arm', values), told);
    this.push_latest = new Latest<Push>((push) => link.request('push', push), told);
    this.tip_latest = new Latest<Vector3, TipResult>(
      (position) => link.request<TipResult>('tip', { position }),
      (result, error) => {
        if (this.is_tip_led) this.tip_result.value = result;
        if (error) notices.error(error);
      },
    );
  }

  arm(values: ArmCommand): void {
    this.playback.go_live();
    this.forget_tip();
    this.arm_latest.ask(values);
  }

  /** Commands a tip position. */
  tip(position: Vector3): void {
    this.playback.go_live();
    this.is_tip_led = true;
    this.tip_goal.value = position;
    this.tip_latest.ask(position);
  }

  /** The user releases the tip. */
  release_tip(): void {
    this.tip_goal.value = null;
  }

  /** The arm gets another target: drops the tip target, including waiting requests. */
  forget_tip(): void {
    this.is_tip_led = false;
    this.tip_latest.forget();
    this.tip_goal.value = null;
    this.tip_result.value = null;
  }

  /** Switches weight and loads of the simulated arm. Resolves to whether the request was accepted. */
  weight(on: boolean): Promise<boolean> {
    this.playback.go_live();
    return this.ask('weight', { on });
  }

  /** Pushes the arm at s: with a spring to a point, or with a force. */
  push(push: Push): void {
    this.playback.go_live();
    this.push_latest.ask(push);
  }

  /** Ends the push and drops waiting push requests. */
  release(): Promise<boolean> {
    this.push_latest.forget();
    return this.ask('release');
  }

  /** Moves a head or a stage: `what` is the request's name. */
  axis(what: 'head' | 'stage', camera: string, values: Record<string, number>): void {
    const key = `${what} ${camera} ${Object.keys(values).join()}`;
    let latest = this.axes.get(key);
    if (!latest) {
      latest = new Latest<Record<string, unknown>>(
        (all) => this.link.request(what, all),
        (_, error) => error && this.notices.error(error),
      );
      this.axes.set(key, latest);
    }
    latest.ask({ camera, ...values });
  }

  /** Sends a request without values: halt, reset, run, cancel, open, live. Resolves to whether it was accepted. */
  plain(what: string): Promise<boolean> {
    if (what === 'reset') this.forget_tip();
    if (what === 'halt') return this.halt();
    return what === 'run' ? this.run() : this.ask(what);
  }

  /** Everything stops, and that is confirmed. */
  async halt(): Promise<boolean> {
    const is_done = await this.ask('halt');
    if (is_done) this.notices.info('Halted: everything has stopped.');
    return is_done;
  }

  /** All tasks, or the one at that place from the experiment's start, as fast as is preferred. */
  run(task?: number): Promise<boolean> {
    this.playback.go_live();
    this.forget_tip();
    const speed = preferences.run_speed.value;
    const seeing = this.seeing?.all_sent() ?? [];
    return this.ask('run', { ...(task !== undefined && { task }), speed, ...(seeing.length > 0 && { seeing }) });
  }

  /** Tasks play so fast from now on: those that run, too. */
  run_speed(speed: number, is_running: boolean): void {
    preferences.run_speed.value = speed;
    if (is_running) void this.speed(speed);
  }

  /** The run in progress plays so fast from now on. */
  speed(speed: number): Promise<boolean> {
    return this.ask('speed', { speed });
  }

  /** Asks for the text of the experiment, with what is to be added of what is shown. */
  experiment(addition: Addition): Promise<ExperimentText> {
    return this.link.request<ExperimentText>('experiment', { ...addition });
  }

  async check(text: string): Promise<TextProblem[]> {
    return (await this.link.request<{ problems: TextProblem[] }>('check', { text })).problems;
  }

  /** Saves a valid text as a new file, whose name comes back. */
  save_experiment(text: string, name: string): Promise<{ problems: TextProblem[]; file?: string }> {
    return this.link.request('save', { text, name });
  }

  /** Replaces the rig by one that starts in the recording's state at this time, s. */
  branch(time: number): Promise<boolean> {
    this.forget_tip();
    return this.ask('branch', { time });
  }

  /** Replaces the present rig by that of one of the hello's examples. */
  open_example(example: string): Promise<boolean> {
    this.forget_tip();
    return this.ask('open', { example });
  }

  private async ask(what: string, values: Record<string, unknown> = {}): Promise<boolean> {
    try {
      await this.link.request(what, values);
      return true;
    } catch (error) {
      this.notices.error(error);
      return false;
    }
  }
}

const reasons: Record<string, string> = {
  not_reachable: 'Out of reach',
  at_limit: 'At the limits of the arm',
  no_convergence: 'No shape found',
};

/** Returns why the tip cannot reach its target; null if it can. */
export function obstruction(result: TipResult): string | null {
  if (result.danger) return result.danger;
  if (result.converged) return null;
  return reasons[result.reason] ?? result.reason;
}
