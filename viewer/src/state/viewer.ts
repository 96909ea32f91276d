// The state of the page and the dispatch of messages.
import { computed, signal } from '@preact/signals';
import { Link, type LinkListener } from '../connection/link';
import { Pictures, type Picture } from '../connection/images';
import type { Entry } from '../connection/entry';
import {
  decode_extras, decode_image, decode_state, flag_running, type ImageMessage, kind_extras, kind_image, kind_of, kind_state, type State,
} from '../protocol/state';
import type { CampaignMessage, ConditionMessage, EventMessage, ExtraOverlay, Extras, GhostMessage, Hello, Layer, ProgressMessage, Scene, TextMessage } from '../protocol/types';
import { Commander } from './commander';
import { History } from './history';
import { Measured } from './measured';
import { Notices } from './notices';
import { Playback } from './playback';
import { preferences } from './preferences';
import { Seeing } from './seeing';
import { extra_ghosts, extra_overlay, OverlayMemory } from '../overlays/extras';
import { shape } from '../overlays/measures';
import { capital } from '../ui/format';

/** Up-to-dateness of the shown state. */
export type Freshness = 'live' | 'held' | 'recording' | 'pictures' | 'stale' | 'lost' | 'none' | 'refused';

const kept_events = 200;
/** Update interval of the panels, ms; the 3D view gets every state. */
const tick_ms = 80;
/**
 * A live rig sends states continuously: without any for this long, ms, there is a fault, even if pings are answered.
 */
const stateless_ms = 3000;
const image_rate = 30;

export class Viewer implements LinkListener {
  readonly notices = new Notices();
  readonly history = new History();
  readonly link: Link;
  readonly playback: Playback;
  readonly commander: Commander;
  readonly pictures: Pictures;
  readonly measured = new Measured();
  readonly seeing = new Seeing();
  /** The camera in whose pictures the user says where the arm is; null: none. */
  readonly finding = signal<string | null>(null);

  readonly hello = signal<Hello | null>(null);
  readonly scene = signal<Scene | null>(null);
  readonly events = signal<EventMessage[]>([]);
  readonly progress = signal<ProgressMessage | null>(null);
  readonly condition = signal<ConditionMessage | null>(null);
  readonly campaign = signal<CampaignMessage | null>(null);
  readonly layers = signal<Record<string, Layer[]>>({});
  /** The newest extras; they belong to the newest pictures. */
  readonly extras = signal<Extras | null>(null);
  /** The extras of the shown state, which may be held. */
  readonly shown_extras = signal<Extras | null>(null);
  /** Ghosts from `ghost` messages. */
  private readonly sent_ghosts = signal<Record<string, GhostMessage>>({});
  /** All ghosts, including extras and the shape estimated from the pictures. */
  readonly ghosts = computed(() => this.all_ghosts());
  /** Increases with each picture of a camera; the picture itself is in `picture_of`. */
  readonly picture_tick = signal(0);
  /** Increases about ten times a second while the shown state changes. */
  readonly tick = signal(0);
  /** Flags of the newest state. */
  readonly flags = signal(0);
  /** The picked point of the backbone, m along the unstretched arm. */
  readonly picked = signal<number | null>(null);
  /** Increases with a new run, a new rig or a restarted program. */
  readonly epoch = signal(0);
  readonly freshness = computed<Freshness>(() => this.judge());

  shown: State | null = null;
  readonly picture_of = new Map<string, Picture>();
  readonly state_listeners = new Set<(state: State) => void>();
  /** Null: there is none at the time that is shown. */
  readonly picture_listeners = new Set<(camera: string, picture: Picture | null) => void>();
  private readonly overlay_memory = new OverlayMemory();
  private readonly stateless = signal(false);
  private last_state = 0;
  /** The next recording plays at once. */
  private plays_next = false;
  private tick_timer: ReturnType<typeof setTimeout> | undefined;

  constructor(entry: Entry) {
    this.link = new Link(this, entry);
    this.pictures = new Pictures((camera, picture) => this.show_picture(camera, picture));
    this.playback = new Playback({
      history: this.history,
      ask_at: (time) => this.link.request('at', { time }),
      show: (state) => this.show(state),
      failed: (error) => this.notices.error(error),
    });
    this.commander = new Commander(this.link, this.notices, this.playback, this.seeing);
    this.measured.start(this, preferences.overlays, this.seeing, this.finding);
    setInterval(() => this.watch_states(), 500);
  }

  get readonly(): boolean {
    const hello = this.hello.value;
    return !hello || hello.readonly || hello.mode !== 'live';
  }

  /** The shown state may be outdated, so the effect of a command would not be visible. */
  get blind(): boolean {
    return this.freshness.value === 'lost' || this.freshness.value === 'stale';
  }

  /** Nothing can be moved: a recording, a run of tasks, or a lost or silent connection. */
  get still(): boolean {
    return this.readonly || (this.flags.value & flag_running) !== 0 || this.blind;
  }

  /** The current state of the rig, even while an earlier one is held; commands start from it. */
  get newest(): State | null {
    return this.history.newest ?? this.shown;
  }

  text(message: TextMessage): void {
    switch (message.type) {
      case 'hello':
        return this.greet(message);
      case 'scene':
        this.scene.value = message.scene;
        return;
      case 'event':
        this.events.value = [...this.events.value.slice(1 - kept_events), message];
        if (message.notice) this.notices.error(capital(message.text));
        return;
      case 'progress':
        return this.take_progress(message);
      case 'condition':
        this.condition.value = message;
        return;
      case 'campaign':
        this.campaign.value = message;
        return;
      case 'overlay':
        this.layers.value = { ...this.layers.value, [message.camera]: message.layers };
        return;
      case 'ghost':
        return this.take_ghost(message);
    }
  }

  /** The recording of the last run, from its start on. */
  async replay(): Promise<void> {
    this.plays_next = true;
    if (!(await this.commander.plain('open'))) this.plays_next = false;
  }

  failed(why: string): void {
    this.notices.error(why);
  }

  bytes(message: ArrayBuffer): void {
    try {
      const kind = kind_of(message);
      if (kind === kind_state) this.take_state(decode_state(message));
      else if (kind === kind_image) void this.take_image(decode_image(message));
      else if (kind === kind_extras) this.take_extras(decode_extras(message));
      // Other kinds belong to later versions and are ignored.
    } catch (error) {
      this.notices.error(error);
    }
  }

  closed(): void {
    this.progress.value = null;
    this.condition.value = null;
    // Whether they still hold nobody knows; who does says so again.
    this.extras.value = null;
  }

  private greet(hello: Hello): void {
    const before = this.hello.value;
    const afresh = !before || before.session !== hello.session || before.mode !== hello.mode
      || before.title !== hello.title || before.duration !== hello.duration;
    this.hello.value = hello;
    this.seeing.take(hello.scene.cameras, `${hello.session} ${hello.title}`);
    this.scene.value = hello.scene;
    if (before && before.session !== hello.session) {
      this.notices.info('The program was started again.');
      this.campaign.value = null;
    }
    if (afresh) {
      this.forget();
      this.playback.start(hello.mode, hello.duration, hello.interval);
    } else {
      this.playback.again();
    }
    if (hello.mode === 'recording' && this.plays_next) this.playback.play();
    this.plays_next = false;
    for (const { name } of hello.scene.cameras) {
      // A recording without pictures refuses this request; the page then shows none.
      this.link.request('images', { camera: name, rate: image_rate }).catch(() => {});
    }
  }

  /** Drops everything of the previous run. */
  private forget(): void {
    this.history.clear();
    this.shown = null;
    this.flags.value = 0;
    this.events.value = [];
    this.progress.value = null;
    this.layers.value = {};
    this.sent_ghosts.value = {};
    this.extras.value = null;
    this.overlay_memory.take(null);
    this.shown_extras.value = null;
    this.picked.value = null;
    this.finding.value = null;
    this.commander.forget_tip();
    this.pictures.reset();
    for (const { bitmap } of this.picture_of.values()) bitmap.close();
    this.picture_of.clear();
    this.picture_tick.value++;
    this.epoch.value++;
  }

  private take_progress(message: ProgressMessage): void {
    this.progress.value = message;
    if (!message.done) return;
    const told = message.text ?? '';
    const text =
      message.outcome === 'cancelled' && told
        ? `The tasks were cancelled: ${told}.`
        : told || `The tasks ended: ${message.outcome ?? 'done'}.`;
    if (message.outcome === 'done') this.notices.info(text);
    else this.notices.error(text);
  }

  private take_ghost(message: GhostMessage): void {
    const { [message.id]: _, ...others } = this.sent_ghosts.value;
    this.sent_ghosts.value = message.poses?.length ? { ...others, [message.id]: message } : others;
  }

  private all_ghosts(): Record<string, GhostMessage> {
    const all = { ...this.sent_ghosts.value, ...extra_ghosts(this.shown_extras.value, preferences.hidden.value) };
    const poses = this.measured.shape.value?.poses;
    if (poses) all[shape.id] = { type: 'ghost', id: shape.id, color: shape.color, poses };
    return all;
  }

  /** What the program draws upon a camera's picture of this number: what was measured in that one. */
  overlay_of(camera: string, number: number | undefined): ExtraOverlay | undefined {
    return extra_overlay(this.extras.value, camera, number) ?? this.overlay_memory.of(camera, number);
  }

  /** They belong to the state that comes next; where that is shown already, to it. */
  private take_extras(extras: Extras | null): void {
    this.overlay_memory.take(extras);
    this.extras.value = extras;
    if (this.playback.held.peek() !== null || !this.shown) return;
    if (extras && extras.time > this.shown.time && this.playback.mode.peek() === 'live') return;
    this.shown.extras = extras;
    this.shown_extras.value = extras;
  }

  private take_state(state: State): void {
    state.extras = this.extras.peek();
    this.last_state = performance.now();
    this.stateless.value = false;
    this.flags.value = state.flags;
    if (this.playback.mode.value === 'recording') {
      this.show(state);
      return;
    }
    this.history.add(state);
    if (this.playback.held.value === null) this.show(state);
  }

  private show(state: State): void {
    this.shown = state;
    this.shown_extras.value = state.extras ?? null;
    for (const listener of this.state_listeners) listener(state);
    this.tick_timer ??= setTimeout(() => {
      this.tick_timer = undefined;
      this.tick.value++;
    }, tick_ms);
  }

  private async take_image(image: ImageMessage): Promise<void> {
    const camera = this.scene.value?.cameras[image.camera]?.name;
    if (camera === undefined) return;
    if (!image.file.length) return this.show_no_picture(camera);
    try {
      await this.pictures.take(camera, image);
    } catch {
      this.notices.error(`A picture of the camera ${camera} could not be read.`);
    }
    // Sent even for an undecodable picture: otherwise the stream would stop.
    this.link.tell('ack', { camera, number: image.number });
  }

  private show_picture(camera: string, picture: Picture): void {
    const before = this.picture_of.get(camera);
    this.picture_of.set(camera, picture);
    for (const listener of this.picture_listeners) listener(camera, picture);
    before?.bitmap.close();
    this.picture_tick.value++;
  }

  /** The camera has seen nothing yet at the time that is shown. */
  private show_no_picture(camera: string): void {
    this.pictures.forget(camera);
    this.picture_of.get(camera)?.bitmap.close();
    this.picture_of.delete(camera);
    for (const listener of this.picture_listeners) listener(camera, null);
    this.picture_tick.value++;
  }

  private watch_states(): void {
    const live = this.playback.mode.value === 'live' && this.link.status.value.kind === 'open';
    this.stateless.value = live && performance.now() - this.last_state > stateless_ms;
  }

  private judge(): Freshness {
    const link = this.link.status.value;
    if (!this.hello.value) return link.kind === 'refused' ? 'refused' : 'none';
    if (link.kind !== 'open') return 'lost';
    if (!this.link.fresh.value || this.stateless.value) return 'stale';
    if (this.hello.value.mode !== 'live') return this.hello.value.mode;
    return this.playback.held.value === null ? 'live' : 'held';
  }
}
