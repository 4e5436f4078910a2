// SPDX-License-Identifier: Apache-2.0
import { testEach } from './every_page';

testEach({ sample: 7, changed: 7, batch: 5, 'batch/batch': 4, vibration: 8 });
