// What the program looks for in the pictures: a new one is a line here. The page draws what comes by its layers' kinds.

export interface Measure {
  /** As `measure` calls the layer; `shape` is a request of its own. */
  id: string;
  label: string;
  /** For those who cannot see the label's place beside the pictures. */
  title: string;
  color: string;
}

export const measures: Measure[] = [
  { id: 'mask', label: 'Mask', title: 'The arm’s pixels', color: '#36c5b4' },
  { id: 'silhouette', label: 'Edges', title: 'The silhouette’s edges, to a part of a pixel', color: '#69db7c' },
  { id: 'axis', label: 'Axis', title: 'The median axis: where the backbone is seen', color: '#ffd43b' },
  { id: 'markers', label: 'Marks', title: 'Markers along the arm', color: '#ff6b6b' },
  { id: 'circle', label: 'Circle', title: 'The circle through the axis; dashed where the axis is no arc', color: '#4dabf7' },
];

/** The arm's shape from the pictures of all cameras together, as a ghost in the 3D view. */
export const shape: Measure = {
  id: 'shape', label: 'Shape', title: 'The arm’s shape from the pictures of both cameras, in the 3D view', color: '#b197fc',
};

export function color_of(id: string): string | undefined {
  return measures.find((measure) => measure.id === id)?.color;
}
