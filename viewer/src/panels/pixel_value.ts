// The exact value of the inspected pixel, kept in step with the shown picture.
import { effect, signal, type ReadonlySignal, type Signal } from '@preact/signals';
import { Latest } from '../connection/latest';
import type { PixelResult } from '../protocol/types';

export interface Pixel {
  camera: string;
  u: number;
  v: number;
}

/** The part of `Viewer` that is needed. */
export interface PictureHost {
  picture_tick: ReadonlySignal<number>;
  picture_of: ReadonlyMap<string, { number: number }>;
  epoch: ReadonlySignal<number>;
  link: {
    status: ReadonlySignal<{ kind: string }>;
    request<Result>(what: string, values: Record<string, unknown>): Promise<Result>;
  };
}

/** A value stays for this long, ms, until that of the next picture arrives. This avoids flicker. */
export const grace_ms = 120;
/** If the answer belongs to another picture than the shown one, the request is repeated after this time, ms. */
const again_ms = 300;

/** A requested pixel of a picture of a run. */
interface Asked extends Pixel {
  number: number;
  epoch: number;
}

function is_same(a: Asked | null, b: Asked): boolean {
  return a !== null && a.camera === b.camera && a.u === b.u && a.v === b.v && a.number === b.number && a.epoch === b.epoch;
}

/** Keeps `value` equal to that of `pixel` in the shown picture, null if unknown. Returns a function that stops this. */
export function follow_pixel(host: PictureHost, pixel: ReadonlySignal<Pixel | null>, value: Signal<PixelResult | null>): () => void {
  /** The newest answer; it may belong to a picture that has not arrived yet. */
  const answer = signal<{ of: Asked; result: PixelResult } | null>(null);
  const again = signal(0);
  let asked: Asked | null = null;
  let outdated: ReturnType<typeof setTimeout> | undefined;
  let repeat: ReturnType<typeof setTimeout> | undefined;
  const say = (result: PixelResult | null): void => {
    clearTimeout(outdated);
    clearTimeout(repeat);
    outdated = repeat = undefined;
    value.value = result;
  };
  const asker = new Latest<Asked, PixelResult>(
    ({ camera, u, v }) => host.link.request<PixelResult>('pixel', { camera, u, v }),
    (result, _, of) => (answer.value = result && { of: { ...of, number: result.number }, result }),
  );
  const stop = effect(() => {
    host.picture_tick.value;
    again.value;
    const at = pixel.value;
    const number = at ? host.picture_of.get(at.camera)?.number : undefined;
    if (!at || number === undefined || host.link.status.value.kind !== 'open') {
      asked = null;
      asker.forget();
      return say(null);
    }
    const wanted = { ...at, number, epoch: host.epoch.value };
    if (answer.value && is_same(answer.value.of, wanted)) return say(answer.value.result);
    outdated ??= setTimeout(() => (value.value = null), grace_ms);
    if (is_same(asked, wanted)) {
      // The answer belongs to a picture that is not shown and may never be.
      repeat ??= setTimeout(() => {
        repeat = undefined;
        asked = null;
        again.value++;
      }, again_ms);
      return;
    }
    asked = wanted;
    asker.ask(wanted);
  });
  return () => {
    stop();
    clearTimeout(outdated);
    clearTimeout(repeat);
  };
}
