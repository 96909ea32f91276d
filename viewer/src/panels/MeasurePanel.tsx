import { measures, shape, type Measure } from '../overlays/measures';
import type { ShapeResult } from '../protocol/types';
import { preferences, toggle_overlay } from '../state/preferences';
import { use_app } from '../ui/app';

/**
 * Selection of the measures drawn on the pictures, and the shape estimated from all of them. `always` is drawn in any
 * case.
 */
export function MeasurePanel({ cameras, always }: { cameras: number; always?: string }) {
  const { viewer } = use_app();
  const wanted = preferences.overlays.value;
  const all: Measure[] = cameras > 1 ? [...measures, shape] : measures;
  return (
    <div class="measures">
      <div class="chips" role="group" aria-label="Measured in the pictures">
        {all.map(({ id, label, title, color }) => (
          <button key={id} type="button" class="chip" aria-pressed={wanted.includes(id) || id === always} title={title}
            aria-label={`${label}: ${title}`} onClick={() => toggle_overlay(id)}>
            <span class="swatch" style={{ background: color }} />{label}
          </button>
        ))}
      </div>
      {cameras > 1 && wanted.includes(shape.id) && <Shape found={viewer.measured.shape.value} />}
    </div>
  );
}

/**
 * Limited to one line, so that the pixel inspector stays visible. Warnings are in the tooltip and for screen readers.
 */
function Shape({ found }: { found: ShapeResult | null }) {
  const doubts = found?.notes.join('; ') ?? '';
  return (
    <p class="shape-said" role="status" title={doubts}>
      {said(found)}
      {doubts && <span class="sr">: {doubts}</span>}
    </p>
  );
}

function said(found: ShapeResult | null): string {
  if (!found) return 'Shape: …';
  if (!found.found) return `No shape: ${found.reason || 'the arm was not found in the pictures'}`;
  const doubtful = found.notes.length ? ', low confidence' : '';
  return `Shape ±${(1000 * (found.sigma ?? 0)).toPrecision(2)} mm, images ${(found.rms_px ?? 0).toPrecision(2)} px off${doubtful}`;
}
