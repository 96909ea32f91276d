// Measures that the program finds in the pictures: one line each. Results are drawn by the kind of their layers.

export interface Measure {
  /** Id of the layer in `measure` results; `shape` is a separate request. */
  id: string;
  label: string;
  /** Accessible description for screen readers. */
  title: string;
  color: string;
}

export const measures: Measure[] = [
  { id: 'mask', label: 'Mask', title: 'The arm’s pixels', color: '#36c5b4' },
  { id: 'silhouette', label: 'Edges', title: 'The silhouette’s edges, with subpixel accuracy', color: '#69db7c' },
  { id: 'axis', label: 'Axis', title: 'Centerline of the arm in the picture', color: '#ffd43b' },
  { id: 'markers', label: 'Marks', title: 'Markers along the arm', color: '#ff6b6b' },
  { id: 'circle', label: 'Circle', title: 'The circle through the centerline; dashed if the centerline is not an arc', color: '#4dabf7' },
];

/** The arm's shape estimated from the pictures of all cameras, shown as a ghost in the 3D view. */
export const shape: Measure = {
  id: 'shape', label: 'Shape', title: 'The arm’s shape estimated from the pictures of the cameras, shown in the 3D view', color: '#b197fc',
};

export function color_of(id: string): string | undefined {
  return measures.find((measure) => measure.id === id)?.color;
}
