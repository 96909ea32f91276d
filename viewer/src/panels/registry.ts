import type { FunctionComponent } from 'preact';
import { ArmPanel } from './ArmPanel';
import { CameraPanel } from './CameraPanel';
import { EventPanel } from './EventPanel';
import { ScenePanel } from './ScenePanel';

export interface Tab {
  id: string;
  label: string;
  Panel: FunctionComponent;
}

/** The tabs on the left; a new panel is one line here and one file beside. */
export const left_tabs: Tab[] = [
  { id: 'arm', label: 'Arm', Panel: ArmPanel },
  { id: 'cameras', label: 'Cameras', Panel: CameraPanel },
  { id: 'scene', label: 'Scene', Panel: ScenePanel },
  { id: 'events', label: 'Events', Panel: EventPanel },
];
