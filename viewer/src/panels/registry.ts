import type { FunctionComponent } from 'preact';
import type { Hello } from '../protocol/types';
import { ArmPanel } from './ArmPanel';
import { CameraPanel } from './CameraPanel';
import { EventPanel } from './EventPanel';
import { ForcePanel, has_forces } from './ForcePanel';
import { ScenePanel } from './ScenePanel';

export interface Tab {
  id: string;
  label: string;
  Panel: FunctionComponent;
  /** Where there may be nothing to show: whether there is. */
  shown?(hello: Hello | null): boolean;
}

/** The tabs on the left; a new panel is one line here and one file beside. */
export const left_tabs: Tab[] = [
  { id: 'arm', label: 'Arm', Panel: ArmPanel },
  { id: 'forces', label: 'Forces', Panel: ForcePanel, shown: has_forces },
  { id: 'cameras', label: 'Cameras', Panel: CameraPanel },
  { id: 'scene', label: 'Scene', Panel: ScenePanel },
  { id: 'events', label: 'Events', Panel: EventPanel },
];
