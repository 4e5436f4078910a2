// SPDX-License-Identifier: Apache-2.0
// The machine at a glance.
import type { MakeView } from '../../shell/context';
import { together } from '../part';
import { chatterPart } from './chatter';
import { errorPart } from './error';
import { overridePart } from './override';
import { pathPart } from './path';
import { reasonsPart } from './reasons';
import { thermalPart } from './thermal';

export const nowView: MakeView = (context) => together('now-view', [errorPart(context), pathPart(context), overridePart(context), reasonsPart(context), chatterPart(context), thermalPart(context)]);
