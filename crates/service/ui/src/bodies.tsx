import { capital, number, placeOf } from './figures';
import { type Body, endOf, withBodies } from './flight';
import { Explained } from './guide';
import { unitOf } from './quantities';
import { Scroll } from './scroll';
import { angleUnit, current } from './store';

/** What left the vehicle, and how each ended; the vehicle first. */
export function Bodies() {
  const run = current.value;
  if (!run || run.flight.bodies.length === 0) return null;
  const { bodies } = run.flight;
  const [, ...drawn] = withBodies(run);
  const hasParents = bodies.some(({ parent }) => parent !== null);
  return (
    <section class="panel" aria-label="Separated bodies">
      <h2>Separated bodies</h2>
      <Scroll label="Table of separated bodies">
        <table>
          <thead>
            <tr>
              <th scope="col">Body</th>
              {hasParents && (
                <th scope="col" class="word">
                  Left
                </th>
              )}
              <th scope="col" class="word">
                Separated by
              </th>
              <th scope="col">at, s</th>
              <th scope="col" class="word">
                End
              </th>
              <th scope="col">at, s</th>
              <th scope="col">Final position</th>
              <th scope="col">Final speed, {unitOf('speed', angleUnit.value)}</th>
            </tr>
          </thead>
          <tbody>
            {bodies.map((body, index) => (
              <Row key={`${index}${body.name}`} body={body} colour={drawn[index]?.colour ?? 0} hasParents={hasParents} />
            ))}
          </tbody>
        </table>
      </Scroll>
      <Warnings bodies={bodies} />
    </section>
  );
}

function Row({ body, colour, hasParents }: { body: Body; colour: number; hasParents: boolean }) {
  const { name, parent, separatedBy, separatedAt, flight } = body;
  return (
    <tr>
      <th scope="row">
        <span class={`swatch run-${colour}`} />
        {name}
      </th>
      {hasParents && <td class="word">{parent ?? 'vehicle'}</td>}
      <td class="word">{separatedBy}</td>
      <td>{number(separatedAt, 5)}</td>
      <td class="word">{capital(endOf(flight.answer))}</td>
      <td>{number(flight.final.time ?? Number.NaN, 5)}</td>
      <td>{placeOf(flight.final, angleUnit.value)}</td>
      <td>{number(flight.final.speed ?? Number.NaN, 4)}</td>
    </tr>
  );
}

/** What the reader should know of the flights of bodies. */
function Warnings({ bodies }: { bodies: Body[] }) {
  const told = bodies.flatMap(({ name, flight }) => flight.answer.warnings.map((warning) => ({ name, ...warning })));
  if (told.length === 0) return null;
  return (
    <ul class="quiet">
      {told.map(({ name, code, detail, time }) => (
        <li key={`${name}${code}${time}`}>
          {name}: {detail} <Explained at={`warnings/${code}`} name={code} />
        </li>
      ))}
    </ul>
  );
}
