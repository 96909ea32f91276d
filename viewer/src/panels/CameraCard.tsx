import { useEffect, useMemo, useRef } from 'preact/hooks';
import { effect, useSignal, type Signal } from '@preact/signals';
import { extra_layers } from '../overlays/extras';
import { nearest_pixel, picture_point, whole, zoomed } from '../math/picture_point';
import { color_of, shape } from '../overlays/measures';
import { draw_layers } from '../overlays/registry';
import type { Corner, Layer, MeasureResult, SceneCamera } from '../protocol/types';
import type { History } from '../state/history';
import { preferences } from '../state/preferences';
import type { Viewer } from '../state/viewer';
import { use_app } from '../ui/app';
import { format_time, lag_of } from '../ui/format';
import { Icon } from '../ui/Icon';
import { Finder } from './finder';
import { FinderPanel } from './FinderPanel';
import { PairedPictures } from './paired';
import type { Pixel } from './pixel_value';

interface Props {
  camera: SceneCamera;
  pixel: Signal<Pixel | null>;
}

/** A live picture counts as old if newer states have been arriving for this long, s. */
const late_s = 1;

/** Live pictures take so long to come: that is not worth a word. */
const live_lag_s = 0.25;

export function CameraCard({ camera, pixel }: Props) {
  const { viewer, enlarged } = use_app();
  const canvas = useRef<HTMLCanvasElement>(null);
  // Lines are as thick on the screen as before when the picture is shown larger.
  const width = useSignal(0);
  useEffect(() => {
    const observer = new ResizeObserver(([{ contentRect }]) => (width.value = contentRect.width));
    observer.observe(canvas.current!);
    return () => observer.disconnect();
  }, []);
  const zoom = useSignal(whole);
  const finder = useMemo(() => new Finder(camera, viewer), [camera]);
  const is_enlarged = enlarged.value === camera.name;
  const is_finding = is_enlarged && viewer.finding.value === camera.name;
  useEffect(() => {
    if (!is_enlarged) zoom.value = whole;
  }, [is_enlarged]);
  useEffect(() => {
    if (!is_finding) return finder.cancel();
    // Before the keys of the page, while a tool is active.
    const keys = (event: KeyboardEvent): void => {
      const at = pixel.peek()?.camera === camera.name && event.target === canvas.current ? pixel.peek() : null;
      if (!finder.key(event.key, at && [at.u, at.v])) return;
      event.preventDefault();
      event.stopPropagation();
    };
    addEventListener('keydown', keys, true);
    return () => removeEventListener('keydown', keys, true);
  }, [is_finding, finder]);
  /** Which picture is drawn, without its pixels. */
  const drawn = useSignal<{ time: number; number: number } | null>(null);
  useEffect(() => {
    const paired = new PairedPictures<CanvasImageSource>((image, spare) => copy_of(image, camera, spare));
    return effect(() => {
      width.value;
      finder.tick.value;
      viewer.picture_tick.value;
      const newest = viewer.picture_of.get(camera.name);
      const result = measured_in(viewer, camera.name);
      const is_measuring = preferences.overlays.value.some((id) => id !== shape.id) || viewer.finding.value === camera.name;
      const chosen = paired.choose(newest ? { ...newest, image: newest.bitmap } : null, result?.number ?? null, is_measuring);
      const is_measured = result !== null && result.number === chosen?.number;
      const layers = [
        ...(viewer.layers.value[camera.name] ?? []), ...(is_measured ? in_colors(result.layers) : []),
        ...extra_layers(viewer.overlay_of(camera.name, chosen?.number), preferences.hidden.value),
        ...(viewer.finding.value === camera.name ? finder.layers(viewer.seeing.choice_of(camera.name)) : []),
      ];
      const here = pixel.value?.camera === camera.name ? pixel.value : null;
      paint(canvas.current!, camera, chosen?.image ?? null, layers, here, zoom.value.factor);
      // Read by tests: what is drawn upon a picture was measured in that one.
      Object.assign(canvas.current!.dataset, { number: chosen?.number ?? '', measured: is_measured ? result.number : '' });
      const before = drawn.peek();
      if (before?.number !== chosen?.number || before?.time !== chosen?.time) drawn.value = chosen && { time: chosen.time, number: chosen.number };
    });
  }, [camera, finder]);
  viewer.picture_tick.value;
  viewer.tick.value;
  const newest = viewer.picture_of.get(camera.name);
  const picture = newest && (drawn.value ?? newest);
  const measured = measured_in(viewer, camera.name);
  const unfound = (measured?.found === false && measured.number === picture?.number && measured.reason) || viewer.overlay_of(camera.name, picture?.number)?.reason;
  const lag = picture ? lag_of(picture.time, viewer.shown?.time, viewer.freshness.value === 'recording' ? viewer.playback.step_s : live_lag_s) : '';
  const is_file = viewer.hello.value?.mode === 'pictures';
  const old = is_file ? null : age(viewer.freshness.value, newest?.time, viewer.history);
  /** Points that are closer together on the screen count as the same, px. */
  const near = (): number => (8 * camera.width) / Math.max(1, canvas.current!.getBoundingClientRect().width);
  const point = (event: PointerEvent): Corner => {
    const at = picture_point(event.clientX, event.clientY, canvas.current!.getBoundingClientRect(), camera);
    const [u, v] = nearest_pixel(at, camera);
    pixel.value = { camera: camera.name, u, v };
    return at;
  };
  const press = (event: PointerEvent): void => {
    const at = point(event);
    if (finder.tool.value === null || event.button !== 0) return;
    canvas.current!.setPointerCapture(event.pointerId);
    finder.press(at, near());
  };
  const enlarge_part = (event: WheelEvent): void => {
    if (!is_enlarged || event.ctrlKey || !event.deltaY) return;
    event.preventDefault();
    const frame = canvas.current!.parentElement!.getBoundingClientRect();
    const [x, y] = [(event.clientX - frame.left) / frame.width, (event.clientY - frame.top) / frame.height];
    zoom.value = zoomed(zoom.value, x, y, event.deltaY < 0 ? 1.25 : 0.8);
  };
  const toggle = (): void => {
    if (is_enlarged) viewer.finding.value = null;
    enlarged.value = is_enlarged ? null : camera.name;
  };
  const find = (): void => {
    viewer.finding.value = is_finding ? null : camera.name;
    if (!is_finding) enlarged.value = camera.name;
  };
  const step = (event: KeyboardEvent): void => {
    if (event.key === 'Enter' && !is_finding) toggle();
    const [du, dv] = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key] ?? [0, 0];
    if ((!du && !dv) || event.altKey) return;
    event.preventDefault();
    const from = pixel.value?.camera === camera.name ? pixel.value : { u: camera.width >> 1, v: camera.height >> 1 };
    const far = event.shiftKey ? 10 : 1;
    pixel.value = { camera: camera.name, ...inside(camera, from.u + far * du, from.v + far * dv) };
  };
  return (
    <figure class="camera" data-old={old !== null} data-enlarged={is_enlarged} data-finding={is_finding} style={{ '--aspect': camera.width / camera.height }}>
      <div class="picture">
        <canvas ref={canvas} width={camera.width} height={camera.height} tabIndex={0} role="img"
          aria-label={`What the camera ${camera.name} sees; arrow keys move the inspected pixel, Enter enlarges`}
          title={is_finding ? '' : is_enlarged ? 'A click makes it small again (Esc). The wheel enlarges a part.' : 'A click enlarges it'}
          data-tool={finder.tool.value !== null} data-coarse={zoom.value.factor > 3}
          style={{ transform: `scale(${zoom.value.factor}) translate(${-100 * zoom.value.x}%, ${-100 * zoom.value.y}%)` }}
          onPointerMove={(event) => finder.move(point(event))} onPointerDown={press} onPointerUp={(event) => finder.release(point(event), near())}
          onDblClick={() => finder.close()} onWheel={enlarge_part} onKeyDown={step} onClick={() => is_finding || toggle()} />
        {!picture && <span class="none">{viewer.freshness.value === 'recording' ? 'No picture yet at this time' : 'No picture'}</span>}
        {picture && old && <span class="old">{old}</span>}
        {picture && !old && unfound && !is_finding && <span class="unfound">{unfound}</span>}
        {picture && !old && viewer.freshness.value === 'held' && <span class="now">Current picture (the 3D view is held)</span>}
      </div>
      <figcaption>
        <b>{camera.name}</b>
        <span class="picture-time" title={picture && !is_file ? 'The middle of the picture’s exposure, and its difference from the shown time' : undefined}>
          {picture && !is_file ? format_time(picture.time) : ''}
          {picture && lag && <em>, {lag}</em>}
        </span>
        <button type="button" class="icon-button" onClick={find} aria-pressed={is_finding} aria-label={`Find the arm: ${camera.name}`}
          title="Region, colour and base of the arm in this picture"><Icon name="region" /></button>
        <button type="button" class="icon-button" onClick={toggle} aria-label={`${is_enlarged ? 'Make small' : 'Enlarge'}: ${camera.name}`}
          title={is_enlarged ? 'Make it small again (Esc)' : 'Enlarge this picture'}><Icon name={is_enlarged ? 'close' : 'enlarge'} /></button>
        {picture && !is_file && (
          <a href={exact(camera.name, viewer)} download={`${camera.name}.png`} title="Save the exact picture (PNG)"
            aria-label={`Save the exact picture of ${camera.name}`}><Icon name="save" /></a>
        )}
      </figcaption>
      {is_finding && <FinderPanel camera={camera} finder={finder} result={measured} />}
    </figure>
  );
}

function measured_in(viewer: Viewer, camera: string): MeasureResult | null {
  return viewer.measured.pictures.value[camera]?.value ?? null;
}

/** In the colours that stand beside their names. */
function in_colors(layers: Layer[]): Layer[] {
  return layers.map((layer) => ({ color: color_of(layer.id), ...layer }));
}

/** The program's pictures are closed when the next one comes. */
function copy_of(image: CanvasImageSource, { width, height }: SceneCamera, spare: CanvasImageSource | undefined): CanvasImageSource {
  const copy = spare instanceof OffscreenCanvas ? spare : new OffscreenCanvas(width, height);
  copy.getContext('2d')!.drawImage(image, 0, 0, width, height);
  return copy;
}

/** Returns the address of the shown picture, lossless: at the recording's time, or the rig's newest. */
function exact(name: string, viewer: Viewer): string {
  const time = viewer.playback.mode.value === 'recording' ? `?time=${viewer.playback.time.value}` : '';
  return `image/${encodeURIComponent(name)}.png${time}`;
}

/** Returns why a picture is not current; null if it is current or its time is unknown. */
function age(freshness: string, time: number | undefined, history: History): string | null {
  if (time === undefined || freshness === 'recording') return null;
  if (freshness === 'lost' || freshness === 'stale') return `Outdated: from ${format_time(time)}`;
  const outdated = history.outdated_for(time);
  return outdated > late_s ? `${outdated.toFixed(1)} s old` : null;
}

function inside({ width, height }: SceneCamera, u: number, v: number): { u: number; v: number } {
  return { u: Math.min(width - 1, Math.max(0, u)), v: Math.min(height - 1, Math.max(0, v)) };
}

function paint(
  canvas: HTMLCanvasElement, camera: SceneCamera, bitmap: CanvasImageSource | null,
  layers: Parameters<typeof draw_layers>[1], pixel: Pixel | null, zoom: number,
): void {
  const context = canvas.getContext('2d');
  if (!context) return;
  context.clearRect(0, 0, camera.width, camera.height);
  if (!bitmap) return;
  context.drawImage(bitmap, 0, 0, camera.width, camera.height);
  // Line widths are in screen pixels, independent of the picture's size.
  const scale = camera.width / Math.max(1, zoom * canvas.clientWidth);
  draw_layers(context, layers, scale);
  if (!pixel) return;
  context.strokeStyle = '#ff4fa3';
  context.lineWidth = 1.5 * scale;
  const half = 6 * scale;
  context.strokeRect(pixel.u + 0.5 - half, pixel.v + 0.5 - half, 2 * half, 2 * half);
}
