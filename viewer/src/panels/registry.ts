import type { FunctionComponent } from 'preact';
import type { Hello } from '../protocol/types';
import { ArmPanel } from './ArmPanel';
import { CameraPanel } from './CameraPanel';
import { CampaignPanel } from './CampaignPanel';
import { EventPanel } from './EventPanel';
import { ForcePanel, has_forces } from './ForcePanel';
import { ScenePanel } from './ScenePanel';

export interface Tab {
  id: string;
  label: string;
  title: string;
  Panel: FunctionComponent;
  /** For panels that may be empty: whether there is content. */
  shown?(hello: Hello | null): boolean;
}

/** The tabs on the left. A new panel needs one line here and one file. */
export const left_tabs: Tab[] = [
  { id: 'campaign', label: 'Runs', title: 'Progress and results of the campaign’s runs', Panel: CampaignPanel, shown: (hello) => hello?.campaign === true },
  { id: 'arm', label: 'Arm', title: 'The arm’s shape and its tip', Panel: ArmPanel },
  { id: 'forces', label: 'Forces', title: 'What pushes the arm, its energies and contacts', Panel: ForcePanel, shown: has_forces },
  { id: 'cameras', label: 'Cameras', title: 'Pan, tilt, zoom and stage of each camera', Panel: CameraPanel },
  { id: 'scene', label: 'Scene', title: 'What the 3D view shows', Panel: ScenePanel },
  { id: 'events', label: 'Events', title: 'The events so far, with their times', Panel: EventPanel },
];
