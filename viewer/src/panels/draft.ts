import { useEffect, useRef } from 'preact/hooks';
import { useSignal } from '@preact/signals';
import { flag_moving } from '../protocol/state';
import { use_app } from '../ui/app';

const settle_ms = 600;

/**
 * The requested value until the rig is at rest; then null, and the sliders show the rig again. Without it a slider
 * would jump back during the drag while the arm is still moving.
 */
export function use_draft<T>(): { value: T | null; set(value: T): void } {
  const { viewer } = use_app();
  const draft = useSignal<T | null>(null);
  const changed = useRef(0);
  const epoch = viewer.epoch.value;
  useEffect(() => {
    draft.value = null;
  }, [epoch]);
  useEffect(() => {
    const timer = setInterval(() => {
      const moving = (viewer.flags.value & flag_moving) !== 0 && viewer.freshness.value === 'live';
      if (draft.value !== null && !moving && performance.now() - changed.current > settle_ms) draft.value = null;
    }, 150);
    return () => clearInterval(timer);
  }, []);
  return {
    value: draft.value,
    set(value) {
      changed.current = performance.now();
      draft.value = value;
    },
  };
}
