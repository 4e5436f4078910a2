// SPDX-License-Identifier: Apache-2.0
import type { MakeView } from '../shell/context';
import type { ViewName } from '../shell/route';
import { chatterView } from './chatter/chatter';
import { contourView } from './contour';
import { machineView } from './machine';
import { motionView } from './motion';
import { nowView } from './now/now';
import { recordView } from './record/list';
import { thermalView } from './thermal';

export const VIEWS: Record<ViewName, MakeView> = {
  now: nowView,
  contour: contourView,
  chatter: chatterView,
  thermal: thermalView,
  motion: motionView,
  record: recordView,
  machine: machineView,
};
