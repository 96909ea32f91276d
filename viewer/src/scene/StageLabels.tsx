// Words at things in the 3D view: the letters of the axes, the scale of the floor. Written by the page, so that they are
// crisp at any resolution of the canvas.
import { useEffect, useRef } from 'preact/hooks';
import { use_app } from '../ui/app';

export function StageLabels() {
  const view = use_app().view.value;
  const layer = useRef<HTMLDivElement>(null);

  useEffect(() => {
    if (!view) return;
    const place = (): void => {
      const box = layer.current!;
      const labels = view.labels;
      while (box.childElementCount > labels.length) box.lastElementChild!.remove();
      while (box.childElementCount < labels.length) box.append(document.createElement('span'));
      labels.forEach(({ kind, text, at }, i) => {
        const word = box.children[i] as HTMLElement;
        if (word.textContent !== text) word.textContent = text;
        word.className = kind;
        const pixel = view.pixel_of(at.x, at.y, at.z);
        word.hidden = !pixel;
        if (pixel) word.style.transform = `translate(${pixel.x.toFixed(1)}px, ${pixel.y.toFixed(1)}px) translate(-50%, -50%)`;
      });
    };
    place();
    view.look_listeners.add(place);
    return () => void view.look_listeners.delete(place);
  }, [view]);

  return <div class="stage-labels" ref={layer} aria-hidden="true" />;
}
