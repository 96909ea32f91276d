// Measurements in the shown pictures, requested picture by picture while they are displayed.
import { effect, signal, type ReadonlySignal, type Signal } from '@preact/signals';
import { Latest } from '../connection/latest';
import { shape as shape_measure } from '../overlays/measures';
import type { MeasureResult, SeeingChoice, ShapeResult } from '../protocol/types';
import type { Seeing } from './seeing';

/** The part of `Viewer` that is needed. */
export interface MeasureHost {
  picture_tick: ReadonlySignal<number>;
  picture_of: ReadonlyMap<string, { number: number }>;
  epoch: ReadonlySignal<number>;
  scene: ReadonlySignal<{ cameras: { name: string }[] } | null>;
  link: {
    status: ReadonlySignal<{ kind: string }>;
    request<Result>(what: string, values: Record<string, unknown>): Promise<Result>;
  };
}

/** A shape stays for this long, ms, until that of the next pictures arrives. */
export const grace_ms = 300;
/** What was measured in a picture stays for this long, ms: its picture stays with it (panels/paired.ts). */
export const picture_grace_ms = 1500;

/** Requests a measurement for each picture; `found` is null if there is no result for the shown one. */
function follow<Result>(
  found: Signal<Result | null>, ask: () => Promise<Result>, shown: () => string | null, grace: number,
): () => void {
  let asked: string | null = null;
  let outdated: ReturnType<typeof setTimeout> | undefined;
  const say = (result: Result | null): void => {
    clearTimeout(outdated);
    outdated = undefined;
    if (found.peek() !== result) found.value = result;
  };
  const expire = (): void => {
    outdated ??= setTimeout(() => say(null), grace);
  };
  const asker = new Latest<string, Result>(ask, (result, _, of) => {
    // Another run, or a later picture, may be shown by now.
    if (asked === null) return;
    say(result && of.split(' ')[0] === asked.split(' ')[0] ? result : null);
    if (of !== asked) expire();
  });
  const stop = effect(() => {
    const now = shown();
    if (now === asked) return;
    asked = now;
    if (now === null) {
      asker.forget();
      return say(null);
    }
    expire();
    asker.ask(now);
  });
  return () => {
    stop();
    asked = null;
    say(null);
  };
}

export class Measured {
  /** Results by camera. */
  readonly pictures = signal<Record<string, Signal<MeasureResult | null>>>({});
  readonly shape = signal<ShapeResult | null>(null);

  /** `wanted`: the measures to display. Returns a function that stops the requests. */
  start(
    host: MeasureHost, wanted: ReadonlySignal<string[]>,
    seeing: Pick<Seeing, 'sent_of' | 'all_sent'> = { sent_of: () => undefined, all_sent: () => [] }, finding: ReadonlySignal<string | null> = signal(null),
  ): () => void {
    let stops: (() => void)[] = [];
    const end = (): void => stops.forEach((stop) => stop());
    const numbers = (cameras: string[]): string | null => {
      host.picture_tick.value;
      const known = cameras.map((camera) => host.picture_of.get(camera)?.number);
      if (host.link.status.value.kind !== 'open' || !cameras.length || known.includes(undefined)) return null;
      return `${host.epoch.value} ${known.join()}`;
    };
    const stop = effect(() => {
      const cameras = host.scene.value?.cameras.map(({ name }) => name) ?? [];
      end();
      this.pictures.value = Object.fromEntries(cameras.map((name) => [name, signal(null)]));
      // Whoever says where the arm is sees its axis.
      const of_layers = (camera: string): string[] => {
        const layers = wanted.value.filter((id) => id !== shape_measure.id);
        return finding.value === camera && !layers.includes('axis') ? [...layers, 'axis'] : layers;
      };
      const chosen = (camera: string): { seeing?: SeeingChoice } => {
        const choice = seeing.sent_of(camera);
        return choice ? { seeing: choice } : {};
      };
      stops = cameras.map((camera) => follow(
        this.pictures.peek()[camera],
        () => host.link.request<MeasureResult>('measure', { camera, layers: of_layers(camera), ...chosen(camera) }),
        () => {
          const [layers, picture] = [of_layers(camera), numbers([camera])];
          return layers.length && picture ? `${picture} ${layers.join()} ${JSON.stringify(chosen(camera))}` : null;
        },
        picture_grace_ms,
      ));
      stops.push(follow(
        this.shape,
        () => host.link.request<ShapeResult>('shape', seeing.all_sent().length ? { seeing: seeing.all_sent() } : {}),
        () => {
          const pictures = wanted.value.includes(shape_measure.id) && cameras.length > 1 ? numbers(cameras) : null;
          return pictures && `${pictures} ${JSON.stringify(seeing.all_sent())}`;
        },
        grace_ms,
      ));
    });
    return () => {
      stop();
      end();
    };
  }
}
