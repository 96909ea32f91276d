// What the user says about the arm in each camera's pictures: region, colour and base (docs/vision.md).
import { signal } from '@preact/signals';
import type { Corner, SceneCamera, SeeingChoice } from '../protocol/types';

/** The largest number of corners that can be drawn. */
export const most_corners = 100;

export class Seeing {
  /** By camera: the choices that differ from those of the experiment. */
  readonly chosen = signal<Record<string, SeeingChoice>>({});
  private cameras: SceneCamera[] = [];
  private of = '';

  /** Takes the cameras of a greeting. The choices stay while `of` and the sizes of the pictures are the same. */
  take(cameras: SceneCamera[], of: string): void {
    const before = this.of === of ? this.cameras : [];
    this.cameras = cameras;
    this.of = of;
    const is_known = (name: string): boolean => {
      const [now, then] = [cameras, before].map((list) => list.find((camera) => camera.name === name));
      return now !== undefined && then !== undefined && now.width === then.width && now.height === then.height;
    };
    const kept = Object.entries(this.chosen.peek()).filter(([name]) => is_known(name));
    this.chosen.value = Object.fromEntries(kept);
  }

  /** Returns what is used for a camera: what the user chose, otherwise what the experiment has. */
  choice_of(camera: string): SeeingChoice {
    return this.chosen.value[camera] ?? this.given_of(camera);
  }

  /** Returns what a request carries: nothing while the experiment's own settings are used. */
  sent_of(camera: string): SeeingChoice | undefined {
    return this.chosen.value[camera];
  }

  /** Returns what a request for several cameras carries. */
  all_sent(): (SeeingChoice & { camera: string })[] {
    return Object.entries(this.chosen.value).map(([camera, choice]) => ({ camera, ...choice }));
  }

  is_changed(camera: string): boolean {
    return this.chosen.value[camera] !== undefined;
  }

  set(camera: string, change: SeeingChoice): void {
    const choice = without_gaps({ ...this.choice_of(camera), ...change });
    if (same(choice, this.given_of(camera))) return this.restore(camera);
    this.chosen.value = { ...this.chosen.value, [camera]: choice };
  }

  clear(camera: string): void {
    this.set(camera, { region: undefined, color: undefined, base: undefined });
  }

  /** Uses what the experiment has. */
  restore(camera: string): void {
    const { [camera]: _, ...others } = this.chosen.value;
    this.chosen.value = others;
  }

  private given_of(name: string): SeeingChoice {
    const given = this.cameras.find((camera) => camera.name === name)?.seeing;
    return without_gaps({ region: given?.region, color: given?.color });
  }
}

function without_gaps({ region, color, base }: SeeingChoice): SeeingChoice {
  return { ...(region?.length && { region }), ...(color && { color }), ...(base && { base }) };
}

function same(a: SeeingChoice, b: SeeingChoice): boolean {
  return JSON.stringify(a) === JSON.stringify(b);
}

/** Returns all corners of a region: two opposite ones are a rectangle. */
export function outline_of(region: Corner[] | undefined): Corner[] {
  if (region?.length !== 2) return region ?? [];
  const [[left, top], [right, bottom]] = region;
  return [[left, top], [right, top], [right, bottom], [left, bottom]];
}

/** Returns the options of `flexura measure` and `estimate` that say the same; "" for nothing. */
export function options_of({ region, color, base }: SeeingChoice, background?: string): string {
  return [
    region && `--region ${region.flat().join()}`, background && `--background ${quoted(background)}`,
    color && `--color ${color.join()}`, base && `--base ${base.join()}`,
  ].filter(Boolean).join(' ');
}

/** Returns the lines of an experiment file that say the same, without the base, which a rig knows itself. */
export function lines_of(camera: string, { region, color }: SeeingChoice, background?: string): string {
  const lines = [
    region && `region = [${region.map((corner) => `[${corner.join(', ')}]`).join(', ')}]`,
    background && `background = ${JSON.stringify(background)}`, color && `color = [${color.join(', ')}]`,
  ].filter(Boolean);
  return lines.length ? ['[[seeing]]', `camera = ${JSON.stringify(camera)}`, ...lines].join('\n') : '';
}

/** Returns a word for a shell. */
export function quoted(word: string): string {
  return /^[\w./,:=+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
}
