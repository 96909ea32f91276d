// The tools with which the user says where the arm is in a camera's pictures.
import { signal } from '@preact/signals';
import { nearest_pixel } from '../math/picture_point';
import type { ColorResult, Corner, Layer, MeasureResult, SceneCamera, SeeingChoice } from '../protocol/types';
import { RegionTool } from '../state/region_tool';
import { outline_of, type Seeing } from '../state/seeing';

export type Tool = 'rectangle' | 'polygon' | 'color' | 'base';

export const region_color = '#ff922b';
export const base_color = '#e599f7';

/** The part of `Viewer` that is needed. */
export interface FinderHost {
  seeing: Seeing;
  link: { request<Result>(what: string, values: Record<string, unknown>): Promise<Result> };
}

export const no_color = 'This picture is gray and has no colour. Draw a region around the arm, or click the arm’s base.';

const hints: Record<Tool, string> = {
  rectangle: 'Drag from corner to corner, or click two opposite corners. Esc cancels.',
  polygon: 'Click the corners. Enter, a double click or a click on the first corner closes the polygon. Backspace removes a corner, Esc cancels.',
  color: 'Click a pixel of the arm. Esc cancels.',
  base: 'Click the arm’s base: where the arm begins. Esc cancels.',
};

export class Finder {
  readonly tool = signal<Tool | null>(null);
  /** What to do next, or why nothing was done. */
  readonly said = signal('');
  /** Increases when the drawn region changes. */
  readonly tick = signal(0);
  private region: RegionTool | null = null;

  constructor(private readonly camera: SceneCamera, private readonly host: FinderHost) {}

  /** Starts a tool, or ends it if it is active. */
  choose(tool: Tool): void {
    const is_active = this.tool.peek() === tool;
    this.cancel();
    if (is_active) return;
    if (tool === 'color' && this.camera.channels === 1) {
      this.said.value = no_color;
      return;
    }
    if (tool === 'rectangle' || tool === 'polygon') this.region = new RegionTool(tool);
    this.tool.value = tool;
    this.said.value = hints[tool];
  }

  cancel(): void {
    this.region = null;
    this.tool.value = null;
    this.said.value = '';
    this.tick.value++;
  }

  /** `near`: points closer than this count as the same, px. */
  press(point: Corner, near: number): void {
    const at = nearest_pixel(point, this.camera);
    if (this.region) return this.take(this.region.press(at, near));
    if (this.tool.peek() === 'base') return this.choose_value({ base: at });
    if (this.tool.peek() === 'color') void this.pick(at);
  }

  move(point: Corner): void {
    if (!this.region) return;
    this.region.move(nearest_pixel(point, this.camera));
    this.tick.value++;
  }

  release(point: Corner, near: number): void {
    if (this.region) this.take(this.region.release(nearest_pixel(point, this.camera), near));
  }

  close(): void {
    if (this.region) this.take(this.region.close());
  }

  /** Handles a key while a tool is active. Returns whether the key was used; `at` is the inspected pixel. */
  key(key: string, at: Corner | null): boolean {
    if (this.tool.peek() === null) return false;
    if (key === 'Escape') return this.cancel(), true;
    if (key === 'Enter' && this.region?.corners.length) return this.close(), true;
    if (key === 'Backspace') {
      this.region?.undo();
      this.tick.value++;
      return true;
    }
    if (key === ' ' && at) return this.press(at, 0), true;
    return false;
  }

  /** Returns what is drawn upon the picture: region and base of a choice, and the region that is being drawn. */
  layers({ region, base }: SeeingChoice): Layer[] {
    const layers: Layer[] = [];
    const line = (points: Corner[], closed: boolean): void => {
      layers.push({ id: 'region', kind: 'polyline', color: region_color, points, closed, dashed: true });
    };
    if (this.region) line(this.region.outline(), this.region.kind === 'rectangle');
    else if (region?.length) line(outline_of(region), true);
    if (this.region) layers.push({ id: 'corners', kind: 'points', color: region_color, points: this.region.corners });
    if (base) layers.push({ id: 'base', kind: 'points', color: base_color, points: [base] });
    return layers;
  }

  private take(region: Corner[] | null): void {
    if (region) return this.choose_value({ region });
    this.said.value = this.region?.problem || (this.region ? hints[this.region.kind] : '');
    this.tick.value++;
  }

  private choose_value(change: SeeingChoice): void {
    this.cancel();
    this.host.seeing.set(this.camera.name, change);
  }

  private async pick([u, v]: Corner): Promise<void> {
    const { name } = this.camera;
    try {
      const { color } = await this.host.link.request<ColorResult>('color', { camera: name, u, v });
      this.choose_value({ color });
    } catch (error) {
      this.said.value = (error as Error).message;
    }
  }
}

/** Returns in one line what was found in a picture. */
export function found_text(result: MeasureResult | null): string {
  if (!result) return 'Searching …';
  if (!result.found) return `Not found: ${result.reason}`;
  const points = (result.layers.find(({ id }) => id === 'axis')?.points ?? []) as Corner[];
  if (points.length < 2) return 'Found.';
  const length = points.slice(1).reduce((sum, [u, v], i) => sum + Math.hypot(u - points[i][0], v - points[i][1]), 0);
  const at = ([u, v]: Corner): string => `(${Math.round(u)}, ${Math.round(v)})`;
  return `Found: an axis of ${Math.round(length)} px, from ${at(points[0])} to ${at(points.at(-1)!)}.`;
}
