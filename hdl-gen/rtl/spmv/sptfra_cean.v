// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// CeAn: sums of a frame's stress b and, with DIRECTION, the direction of the push (Eq. 24), for Op.
//
// Stresses come in one a cycle, taxel by taxel in rows. The result follows 4 cycles after the last one, with
// DIRECTION 12 and two divisions. The results of up to two frames wait for Op.

`default_nettype none

module sptfra_cean #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // 1: the direction of the push too; 0: for an estimator that needs none
    parameter integer DIRECTION = 0,
    // 1: the sensor reads what pulls, so that a frame in which nothing does is to be told
    parameter integer TENSION_READ = 1,
    // 1: the stress at the grid's border is summed up, for the standard error
    parameter integer WITH_ERROR = 0,
    // Pitch in x over the larger pitch, 16 fraction bits
    parameter signed [17:0] PITCH_X = 18'sd65536,
    // Pitch in y over the larger pitch, 16 fraction bits
    parameter signed [17:0] PITCH_Y = 18'sd65536,
    // From the last stress to the result, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    // From Bz
    output wire idle,
    input  wire stress_valid,
    input  wire signed [26:0] stress,
    input  wire frame_done, // one cycle, with the last stress or after it
    input  wire frame_saturated,
    input  wire frame_not_finite,
    input  wire frame_bad_length,
    input  wire [29:0] frame_replaced, // sum of what took the place of dead taxels
    // Thresholds of the frame, in steps of the stress: a taxel's noise, and the least sum |b| of a contact
    input  wire [26:0] noise,
    input  wire [39:0] contact,
    output wire frame_take, // the next frame's from the second cycle on
    // To Op
    output wire direction_room, // for the result of another frame
    output wire direction_valid,
    input  wire direction_take,
    output wire signed [26:0] direction_x, // d = c - t in units of the larger pitch, 20 fraction bits
    output wire signed [26:0] direction_y,
    output wire no_direction, // nothing pushes, or nothing pulls
    output wire [39:0] stress_sum, // sum |b|
    output wire [26:0] largest, // max |b|
    output wire [39:0] border, // sum |b| of the taxels at the grid's border
    output wire [5:0] flags // no tension, too much replaced, no contact, saturated, NaN or infinity, bad length
);

    // ---- Stage 1: magnitude; stage 2: sum and maximum
    reg valid_1;
    reg tensile_1;
    reg [26:0] magnitude_1;
    reg [39:0] sum;
    reg [26:0] most;
    reg pulled; // a stress was above the noise floor
    reg clear; // for a new frame; after a reset too, and nothing is valid in that cycle

    always @(posedge clock) begin
        valid_1 <= stress_valid;
        tensile_1 <= !stress[26];
        magnitude_1 <= stress[26] ? -stress : stress;
        if (valid_1) begin
            sum <= sum + {13'd0, magnitude_1};
            most <= (magnitude_1 > most) ? magnitude_1 : most;
            pulled <= pulled || (tensile_1 && (magnitude_1 > noise));
        end
        if (reset) begin
            valid_1 <= 1'b0;
        end
        if (clear) begin
            sum <= 40'd0;
            most <= 27'd0;
            pulled <= 1'b0;
        end
    end

    // ---- Place of the taxel in stage 1, and the sum of those at the grid's border
    localparam integer LAST_X = COLUMNS - 1;
    localparam integer LAST_Y = ROWS - 1;
    reg [5:0] x;
    reg [5:0] y;
    reg [39:0] at_edge;
    wire row_ends = (x == LAST_X[5:0]);
    wire is_edge = row_ends || (x == 6'd0) || (y == 6'd0) || (y == LAST_Y[5:0]);
    wire [39:0] edge_sum = (WITH_ERROR != 0) ? at_edge : 40'd0;

    always @(posedge clock) begin
        if (valid_1) begin
            x <= row_ends ? 6'd0 : x + 6'd1;
            y <= row_ends ? y + 6'd1 : y;
            at_edge <= at_edge + (is_edge ? {13'd0, magnitude_1} : 40'd0);
        end
        if (clear) begin
            x <= 6'd0;
            y <= 6'd0;
            at_edge <= 40'd0;
        end
    end

    // ---- Centroids and direction
    wire measured; // at the end of MEASURE
    wire signed [26:0] push_x;
    wire signed [26:0] push_y;
    wire no_push;

    // ---- After the last stress
    localparam [1:0] COLLECT = 2'd0, MEASURE = 2'd1, PUSH = 2'd2;

    reg [1:0] state;
    reg below_floor;
    reg guessed; // more than an eighth of the stress is what neighbours say of dead taxels
    reg [29:0] replaced;
    reg [2:0] faults; // saturated, NaN or infinity, bad length

    assign idle = (state == COLLECT);

    always @(posedge clock) begin
        clear <= reset;
        below_floor <= (sum < contact);
        guessed <= ({7'd0, replaced, 3'd0} > sum);
        case (state)
            COLLECT: begin
                if (frame_done) begin
                    faults <= {frame_saturated, frame_not_finite, frame_bad_length};
                    replaced <= frame_replaced;
                    state <= MEASURE;
                end
            end
            MEASURE: begin
                if (measured) begin
                    state <= PUSH;
                end
            end
            default: begin
                clear <= 1'b1;
                state <= COLLECT;
            end
        endcase
        if (reset) begin
            state <= COLLECT;
        end
    end

    if (DIRECTION != 0) begin : gen_direction
        sptfra_direction #(
            .COLUMNS (COLUMNS),
            .ROWS    (ROWS),
            .PITCH_X (PITCH_X),
            .PITCH_Y (PITCH_Y)
        ) direction (
            .clock     (clock),
            .reset     (reset),
            .clear     (clear),
            .noise     (noise),
            .valid     (valid_1),
            .x         (x),
            .y         (y),
            .tensile   (tensile_1),
            .magnitude (magnitude_1),
            .start     (idle && frame_done),
            .done      (measured),
            .push_x    (push_x),
            .push_y    (push_y),
            .no_push   (no_push)
        );
    end else begin : gen_none
        // The sum, then its comparison
        reg settled;

        always @(posedge clock) begin
            settled <= (state == MEASURE);
        end

        assign measured = settled;
        assign push_x = 27'sd0;
        assign push_y = 27'sd0;
        assign no_push = 1'b1;

        wire _unused = &{1'b0, tensile_1, PITCH_X, PITCH_Y};
    end

    // ---- Two buffers for finished frames: never full, since Bz asks first
    wire no_tension = (TENSION_READ != 0) && !pulled;
    wire [167:0] pushed = {push_x, push_y, no_push, sum, most, edge_sum, no_tension, guessed, below_floor, faults};
    reg [167:0] waiting_0;
    reg [167:0] waiting_1;
    reg [1:0] waiting;
    wire push = (state == PUSH);

    assign frame_take = push;
    assign direction_valid = (waiting != 2'd0);
    assign direction_room = (waiting != 2'd2);
    assign {direction_x, direction_y, no_direction, stress_sum, largest, border, flags} = waiting_0;

    always @(posedge clock) begin
        waiting <= waiting + {1'b0, push} - {1'b0, direction_take};
        // A place that has nothing follows what may come
        if (direction_take || !direction_valid) begin
            waiting_0 <= waiting[1] ? waiting_1 : pushed;
        end
        if (direction_take || direction_room) begin
            waiting_1 <= pushed;
        end
        if (reset) begin
            waiting <= 2'd0;
        end
    end

`ifdef SIMULATION
    reg pushed_1;

    always @(posedge clock) begin
        pushed_1 <= push && !reset;
    end

    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (idle && frame_done),
        .done  (pushed_1)
    );
`else
    wire _unused = (EXPECTED_LATENCY != 0);
`endif

endmodule

`default_nettype wire
