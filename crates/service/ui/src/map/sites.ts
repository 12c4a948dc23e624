import type { GeoProjection } from 'd3-geo';
import { colour } from '../colours';
import type { ListedSite } from '../sites';
import { seen } from './view';

/** How near, in pixels, a pointer is to a site that it means. */
const NEAR = 8;

/** Draws sites as small marks: squares where vehicles start, rings where they come down. */
export function drawSites(ctx: CanvasRenderingContext2D, projection: GeoProjection, sites: ListedSite[]): void {
  ctx.lineWidth = 1;
  ctx.strokeStyle = colour('muted');
  ctx.fillStyle = colour('surface');
  for (const site of sites) {
    const point = seen(projection, [site.longitude, site.geodetic_latitude]);
    if (!point) continue;
    const [x, y] = point;
    ctx.beginPath();
    if (site.kind === 'launch') ctx.rect(x - 2, y - 2, 4, 4);
    else ctx.arc(x, y, 2.2, 0, 2 * Math.PI);
    ctx.fill();
    ctx.stroke();
  }
}

/** The site that is nearest to a point of the screen, where one is near. */
export function siteAt(projection: GeoProjection, sites: ListedSite[], [x, y]: [number, number]): ListedSite | null {
  let [best, least]: [ListedSite | null, number] = [null, NEAR ** 2];
  for (const site of sites) {
    const point = seen(projection, [site.longitude, site.geodetic_latitude]);
    if (!point) continue;
    const distance = (point[0] - x) ** 2 + (point[1] - y) ** 2;
    if (distance < least) [best, least] = [site, distance];
  }
  return best;
}
