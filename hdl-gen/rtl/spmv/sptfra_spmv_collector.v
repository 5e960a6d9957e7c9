// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Collector of the PEs' results: takes one in each write-back slot, rounds it and puts it on the result bus.
//
// Take to bus: 3 cycles. Rounding: to the nearest step, ties upwards. The order in which results become ready is
// fixed. So a ROM holds a word for each slot: {last of its program, PE, destination, row}.
//
// | destination | 4 channels: components       | 1 channel: taxels                    |
// |-------------|------------------------------|--------------------------------------|
// | 0           | y, to We                     | the same                             |
// | 1 2 3       | u0, u1, u2                   | the same                             |
// | 4           | sums of the frame, to Co     | 4 5 6: A_p b, p = 1 2 3, to Co       |
// | 5 6 7       | r0, r1, r2, stored           | 7 to 15: g_pq at 7 + 3 (p - 1) + q   |
// | 8           | r, stored                    |                                      |
// | 9 10 11     | A_p r, p = 1 2 3, the field  |                                      |
//
// With four channels a result has four parity components. No other module knows these numbers: on the bus each
// destination has a bit of its own, in ports named by what the result is. Of components 4 is result_g[0], 5 to 8 are
// result_kept. Of taxels 4 to 6 are result_kept, 7 to 15 result_g.

`default_nettype none

module sptfra_spmv_collector #(
    // PEs, and multiply-accumulates of each in a cycle
    parameter PES = 4,
    parameter CHANNELS = 4,
    // Bits of a result
    parameter DATA_BITS = 27,
    // Elements of a vector: taxels, or orbits of a folded grid
    parameter ELEMENTS = 25,
    // Whether products for y are computed by the diagonal mirror of those for x
    parameter MIRROR = 0,
    // Bits of a destination in the ROM
    parameter DESTINATION_BITS = 4,
    // Bits dropped of a sum by destination, 6 each, destination 0 lowest; the least and the largest of them
    parameter [95:0] SHIFTS = {16{6'd16}},
    parameter LEAST_SHIFT = 16,
    parameter LARGEST_SHIFT = 16,
    // Bits of a PE's result. The lowest one is half of 2^LEAST_SHIFT steps of the sum
    parameter RESULT_BITS = 28,
    // 1: while a program's last slot waits, the ROM's address is that of the next program's first one, if that has
    // begun: two cycles from one slot to the other. 0: four
    parameter AHEAD = 0,
    // Words of the ROM
    parameter SLOT_DEPTH = 200,
    // Prefix of the ROM file name, and the name
    parameter ROM_DIR = "",
    parameter SLOTS_FILE = "",
    // Derived
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3,
    parameter SLOT_WIDTH = (SLOT_DEPTH > 2) ? $clog2(SLOT_DEPTH) : 1
) (
    input  wire clock,
    input  wire reset,
    input  wire restart, // one or two cycles before the first issue of a program
    input  wire [SLOT_WIDTH-1:0] start_slot, // its first write-back slot
    // From the PEs
    input  wire [RESULT_BITS*CHANNELS*PES-1:0] results,
    input  wire [PES-1:0] pending,
    output wire [PES-1:0] take,
    // Result bus
    output wire result_y, // of these one bit with each result, none without
    output wire [2:0] result_u,
    output wire [8:0] result_g, // of taxels g_pq at 3 (p - 1) + q, of components their sums at 0
    output wire [3:0] result_kept, // of taxels A_p b at p - 1, of components r, r2, r1, r0
    output wire [2:0] result_force, // A_p r
    output reg  [ROW_WIDTH-1:0] result_row,
    output reg  [CHANNELS*DATA_BITS-1:0] result_value, // component 0 in the lowest bits
    output reg  result_last // of its program
);

    if ((MIRROR != 0) && (CHANNELS != 4)) begin : gen_check_mirror
        sptfra_error_only_four_channels_are_mirrored invalid ();
    end

    localparam TAKE_TO_BUS = 3; // cycles, which simulations check
    localparam PE_WIDTH = (PES > 2) ? $clog2(PES) : 1;
    localparam WORD_WIDTH = 1 + PE_WIDTH + DESTINATION_BITS + ROW_WIDTH;
    localparam [5:0] LEAST = LEAST_SHIFT;
    // What a shift is more than the least one
    localparam MORE_BITS = (LARGEST_SHIFT > LEAST_SHIFT) ? $clog2(LARGEST_SHIFT - LEAST_SHIFT + 1) : 1;
    localparam SPREAD_BITS = DATA_BITS + (1 << MORE_BITS); // of a result before that shift
    localparam [3:0] Y = 4'd0, U1 = 4'd2, U2 = 4'd3, R1 = 4'd6, R2 = 4'd7, FORCE_X = 4'd9, FORCE_Y = 4'd10;

    // ---- The next slot, one word ahead of the ROM; after a program's last one, on to the program that has begun
    reg  [SLOT_WIDTH-1:0] slot_count;
    reg  slot_known;
    reg  stopped;
    reg  jump_waits;
    reg  [SLOT_WIDTH-1:0] jump_target;
    reg  last;
    reg  [PE_WIDTH-1:0] pe;
    reg  [DESTINATION_BITS-1:0] destination;
    reg  [ROW_WIDTH-1:0] row;
    wire [WORD_WIDTH-1:0] slot;
    reg  [PES-1:0] select; // PE, one bit each
    reg  separated; // both halves of y are written: the next result waits a cycle
    wire may_take = slot_known && !separated;
    wire taking = (take != {PES{1'b0}});
    wire ends = taking && last;
    wire jump = stopped && jump_waits;
    wire fetch = taking || !slot_known;
    reg  filling; // the ROM's first word is on its way
    reg  aimed; // the address is the next program's, and the slot is the last of this one
    wire loads = fetch && !stopped && !ends && !filling; // a slot
    wire at_last = loads ? slot[WORD_WIDTH-1] : slot_known && last && !taking;
    wire aim = (AHEAD != 0) && at_last && !aimed && jump_waits;

    sptfra_rom #(
        .WIDTH         (WORD_WIDTH),
        .DEPTH         (SLOT_DEPTH),
        .ADDRESS_WIDTH (SLOT_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          (SLOTS_FILE)
    ) slots (
        .clock   (clock),
        .enable  (fetch),
        .address (slot_count),
        .data    (slot)
    );

    always @(posedge clock) begin
        if (jump || aim) begin
            slot_count <= jump_target;
        end else if (fetch) begin
            slot_count <= slot_count + 1;
        end
        filling <= jump;
        slot_known <= !stopped && !ends && !filling;
        if (fetch) begin
            {last, pe, destination, row} <= slot;
        end
        if (restart) begin
            jump_target <= start_slot;
            jump_waits <= 1'b1;
        end else if (jump || (ends && aimed)) begin
            jump_waits <= 1'b0;
        end
        aimed <= (aimed || aim) && !ends;
        if (ends) begin
            stopped <= !aimed;
        end else if (jump) begin
            stopped <= 1'b0;
        end
        separated <= (CHANNELS > 1) && taking && (destination == Y[DESTINATION_BITS-1:0]);
        if (reset) begin
            slot_count <= {SLOT_WIDTH{1'b0}};
            slot_known <= 1'b0;
            stopped <= 1'b1;
            jump_waits <= 1'b0;
            aimed <= 1'b0;
            separated <= 1'b0;
        end
    end

    genvar index;
    for (index = 0; index < 16; index = index + 1) begin : gen_check_shifts
        if ((SHIFTS[6*index +: 6] < LEAST) || (SHIFTS[6*index +: 6] > LARGEST_SHIFT)) begin : gen_check
            sptfra_error_each_shift_lies_from_the_least_to_the_largest invalid ();
        end
    end
    for (index = 0; index < PES; index = index + 1) begin : gen_select
        always @(posedge clock) begin
            if (fetch) begin
                select[index] <= (PES == 1) || (slot[DESTINATION_BITS+ROW_WIDTH +: PE_WIDTH] == index);
            end
        end
    end

`ifdef SIMULATION
    // By the schedule a program's first slot is reached before the next program begins
    always @(posedge clock) begin
        if (!reset && restart && jump_waits && !jump && !(ends && aimed)) begin
            $fdisplay(32'h80000002, "%m: a program has begun while the one before waits for its first slot");
            $fatal(1);
        end
    end
`endif

    // ---- Result that was taken
    wire [RESULT_BITS*CHANNELS-1:0] result_of [0:PES-1];
    reg [RESULT_BITS*CHANNELS-1:0] taken;
    reg taken_valid;
    reg [DESTINATION_BITS-1:0] taken_destination;
    reg [5:0] taken_shift;
    reg [ROW_WIDTH-1:0] taken_row;

    for (index = 0; index < PES; index = index + 1) begin : gen_results
        assign result_of[index] = results[RESULT_BITS*CHANNELS*index +: RESULT_BITS*CHANNELS];
    end

    assign take = select & pending & {PES{may_take}};

    always @(posedge clock) begin
        taken <= result_of[pe];
        taken_valid <= taking;
        taken_destination <= destination;
        taken_shift <= SHIFTS[6*destination +: 6];
        taken_row <= row;
        if (reset) begin
            taken_valid <= 1'b0;
        end
    end

    // ---- Shift by destination, down to half a step of the result. The format of each result was chosen so that its
    // worst case fits: the bits above are copies of the sign
    wire [5:0] taken_more = taken_shift - LEAST;
    wire [15:0] taken_is = 16'd1 << taken_destination; // bit k: of destination k
    reg shifted_valid;
    reg [DESTINATION_BITS-1:0] shifted_destination;
    reg odd_x; // of a result that is odd in x
    reg odd_y;
    reg [ROW_WIDTH-1:0] shifted_row;
    reg [CHANNELS*(DATA_BITS+1)-1:0] shifted;
    wire _unused_taken = &{1'b0, taken_more, taken_is};

    for (index = 0; index < CHANNELS; index = index + 1) begin : gen_channels
        wire [RESULT_BITS-1:0] of_channel = taken[RESULT_BITS*index +: RESULT_BITS];
        wire [RESULT_BITS+SPREAD_BITS-1:0] wide = { {SPREAD_BITS{of_channel[RESULT_BITS-1]}}, of_channel};
        wire [SPREAD_BITS-1:0] spread = wide[SPREAD_BITS-1:0] >> taken_more[MORE_BITS-1:0];

        always @(posedge clock) begin
            shifted[(DATA_BITS+1)*index +: DATA_BITS+1] <= spread[DATA_BITS:0];
        end

        wire _unused = &{1'b0, wide, spread};
    end

    always @(posedge clock) begin
        shifted_valid <= taken_valid;
        shifted_destination <= taken_destination;
        shifted_row <= taken_row;
        odd_x <= taken_is[U1] || taken_is[R1] || taken_is[FORCE_X];
        odd_y <= taken_is[U2] || taken_is[R2] || taken_is[FORCE_Y];
        if (reset) begin
            shifted_valid <= 1'b0;
        end
    end

    // ---- Bus: the components from the channels that computed them, rounded
    reg [CHANNELS*(DATA_BITS+1)-1:0] ordered;
    reg [15:0] route; // bit k: of destination k
    reg [2:1] lasts;

    always @(posedge clock) begin
        route <= (16'd1 << shifted_destination) & {16{shifted_valid}};
        result_row <= shifted_row;
        {result_last, lasts} <= {lasts, ends};
        if (reset) begin
            route <= 16'd0;
            {result_last, lasts} <= 3'd0;
        end
    end

    for (index = 0; index < CHANNELS; index = index + 1) begin : gen_rounded
        wire [DATA_BITS:0] of_channel = ordered[(DATA_BITS+1)*index +: DATA_BITS+1];

        always @(posedge clock) begin
            result_value[DATA_BITS*index +: DATA_BITS] <= of_channel[DATA_BITS:1]
                + { {(DATA_BITS - 1){1'b0}}, of_channel[0]};
        end
    end

    sptfra_check_latency #(
        .CYCLES    (TAKE_TO_BUS),
        .PIPELINED (1)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (taking),
        .done  (route != 16'd0)
    );

    assign {result_u, result_y} = route[3:0];

    if (CHANNELS == 4) begin : gen_components
        assign {result_force, result_kept} = route[11:5];
        assign result_g = {8'd0, route[4]};
        wire _unused = &{1'b0, route[15:12]};

        wire [DATA_BITS:0] channel_0 = shifted[(DATA_BITS+1)*0 +: DATA_BITS+1];
        wire [DATA_BITS:0] channel_1 = shifted[(DATA_BITS+1)*1 +: DATA_BITS+1];
        wire [DATA_BITS:0] channel_2 = shifted[(DATA_BITS+1)*2 +: DATA_BITS+1];
        wire [DATA_BITS:0] channel_3 = shifted[(DATA_BITS+1)*3 +: DATA_BITS+1];

        always @(*) begin
            if (odd_x) begin
                ordered = {channel_2, channel_3, channel_0, channel_1};
            end else if (odd_y && (MIRROR != 0)) begin
                ordered = {channel_2, channel_0, channel_3, channel_1};
            end else if (odd_y) begin
                ordered = {channel_1, channel_0, channel_3, channel_2};
            end else begin
                ordered = shifted;
            end
        end
    end else begin : gen_taxels
        assign result_g = route[15:7];
        assign result_kept = {1'b0, route[6:4]};
        assign result_force = 3'd0;

        always @(*) begin
            ordered = shifted;
        end
        wire _unused = &{1'b0, odd_x, odd_y};
    end

endmodule

`default_nettype wire
